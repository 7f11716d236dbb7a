//! The texts of the menus of rendering and of the window's looks.

texts! { LooksText;
    Rendering: "Rendering", "渲染设置";
    HelpRendering: "Film size, renderer, seed, roulette; start again", "画幅、渲染器、随机数种子、轮盘赌；重新开始";
    Looks: "Window", "窗口";
    HelpLooks: "Panels, theme, contrast, size, motion, language", "面板、主题、对比度、大小、动画、语言";
    Contrast: "High contrast", "高对比度";
    HelpContrast: "Stronger text and lines: for projectors and tired eyes", "更深的文字和更粗的线条：适合投影和疲劳的眼睛";
    Motion: "Reduced motion", "减少动画";
    HelpMotion: "Nothing moves by itself", "界面元素不播放动画";
    Scale: "Size of everything", "界面大小";
    HelpScale: "Larger for a projector, smaller for more room; as far as the window has room for it", "投影时放大，需要空间时缩小；以窗口能容纳为限";
    ResetLayout: "Reset the layout", "重置布局";
    HelpResetLayout: "Panels as at the first start", "恢复面板的初始布局";
}
