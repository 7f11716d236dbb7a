//! The texts of the menus of rendering and of the window's looks.

texts! { LooksText;
    Rendering: "Rendering", "渲染设置";
    HelpRendering: "Film size, renderer, random numbers, roulette; start again", "画幅、渲染器、随机数、轮盘赌；重新开始";
    Sampler: "Random numbers", "随机数";
    HelpSampler: "How the random numbers of a pixel's samples go together. Different seeds are independent either way.", "同一像素各采样的随机数如何分布。不同种子之间总是独立。";
    SamplerHash: "Independent", "独立";
    HelpSamplerHash: "Every sample has random numbers of its own: how samples differ tells how far their mean is from the truth.", "各采样的随机数各自独立：由采样之间的差异可以得出均值的误差。";
    SamplerSobol: "Even (Sobol)", "均匀（Sobol）";
    HelpSamplerSobol: "The samples of a pixel fill the space of their random numbers evenly: less noise after as many samples. How they differ no longer tells the error, so that no confidence interval is given.", "像素的各采样均匀分布：采样数相同而噪声更少。采样之间的差异不再给出误差，因此没有置信区间。";
    LightSubpaths: "Light subpaths", "光源子路径数";
    HelpLightSubpaths: "For each eye subpath, which meets the first of them. The others serve the light tracer alone: worth it where most light comes by s ≥ 2, t = 1.", "每条视线子路径对应的光源子路径数。视线子路径只与第一条连接，其余只用于光线追踪策略：适合大部分光来自 s ≥ 2、t = 1 的场景。";
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
