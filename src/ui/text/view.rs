//! The texts of the image view, the vertex card and the window's looks.

texts! { ViewText;
    Title: "View", "视图";
}
