//! The texts of the first steps.

texts! { TourText;
    Pixel: "Click anywhere in the image: the paths of that pixel appear.", "点击图像任意处：显示生成该像素的路径。";
    Sample: "Press N, or Next: every sample of a pixel is another pair of subpaths.", "按 N 或“下一个”：像素的每个采样都是另一对子路径。";
    Strategy: "Click a strategy in the table or in the pyramid: the path it makes is drawn in violet.", "在表格或金字塔中点击一个策略：它生成的路径以紫色画出。";
    Hide: "Press H: the strategy is left out of the sum, and the image loses just that light. H brings it back.", "按 H：该策略不计入总和，图像只失去这部分光。再按 H 恢复。";
    Splits: "Open Splits: the very same path, made by every other strategy, with their weights.", "打开“拆分”：同一条路径由其他各策略生成时的密度与权重。";
    Step: "{} of {}", "第 {} 步，共 {} 步";
    Later: "Skip this", "跳过这一步";
    Close: "Close the tour", "关闭导览";
    Again: "Show the first steps", "显示入门导览";
    HelpAgain: "A few small steps through the window", "用几个小步骤认识窗口";
}
