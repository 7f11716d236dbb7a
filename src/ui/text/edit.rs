//! The texts of the scene's page and of whatever changes the scene.

texts! { EditText;
    Title: "Scene", "场景";
}
