//! The texts of the 3-D view.

texts! { SpaceText;
    Title: "3-D view", "三维视图";
}
