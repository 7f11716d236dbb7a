//! The texts of saving.

texts! { ExportText;
    Title: "Save", "保存";
}
