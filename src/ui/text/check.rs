//! The texts of the checks.

texts! { CheckText;
    Title: "Checks", "检查";
}
