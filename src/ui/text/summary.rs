//! The texts of the summary in words, and of the page around the window.

texts! { SummaryText;
    Title: "What is selected, in words", "所选内容的文字说明";
    Now: "Pixel {}, {}, sample {}, {}: {}", "像素 {}, {}，采样 {}，{}：{}";
    Carries: "weight {}, contribution {} W m⁻² sr⁻¹", "权重 {}，贡献 {} W m⁻² sr⁻¹";
    Scene: "Scene {}, {}×{} pixels, seed {}, paths of up to {} edges", "场景 {}，{}×{} 像素，种子 {}，路径最多 {} 条边";
    Selected: "Selected strategy: {}", "所选策略：{}";
    Vertices: "The vertices of its path, from the light to the eye", "其路径的顶点，从光源到视点";
    Vertex: "{}: {}", "{}：{}";
    Dirac: "mirror or glass: a Dirac", "镜面或玻璃：狄拉克函数";
    Chosen: "selected", "已选";
    Strategies: "All strategies of this sample", "该采样的全部策略";
    Light: "carries light", "是否有光";
    Yes: "yes", "是";
    Rendering: "The rendering", "渲染情况";
    Mean: "Mean of the pixel over {} samples: {} W m⁻² sr⁻¹", "像素 {} 个采样的平均：{} W m⁻² sr⁻¹";
    NoMean: "The pixel has no mean yet: the first pass goes on.", "像素还没有平均值：第一遍渲染尚未完成。";
    TextView: "Text view", "文字视图";
    HelpTextView: "What is selected, in words, beside the window: for screen readers, for copying, for everybody", "在窗口旁用文字说明所选内容：便于屏幕阅读器、复制和所有人使用";
    CloseTextView: "Close the text view", "关闭文字视图";
    ToText: "To what is selected, in words", "转到所选内容的文字说明";
    ToWindow: "Back to the window", "返回窗口";
    KeyLeave: "Out of the window, to what is selected in words, and back", "离开窗口，转到所选内容的文字说明，再按返回窗口";
}
