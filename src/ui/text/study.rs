//! The texts of the pyramid's modes, of comparisons and of why a cell is empty.

texts! { StudyText;
    Title: "Compare", "比较";
}
