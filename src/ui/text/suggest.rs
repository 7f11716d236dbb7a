//! The texts of the suggestion of strategies.

texts! { SuggestText;
    Open: "Which does the scene need?…", "场景需要哪些策略？…";
    HelpOpen: "A pilot run of a few seconds judges what other sets of strategies would do here: variance, cost, efficiency", "用几秒钟的试运行评估其他策略集合在此场景的表现：方差、成本、效率";
    Title: "Which strategies does this scene need?", "此场景需要哪些策略？";
    Running: "Judging sets of strategies by the same samples…", "正在用相同的采样评估各策略集合…";
    Stale: "Scene, camera or settings have changed since.", "此后场景、相机或设置已更改。";
    Again: "Judge again", "重新评估";
    Intro: "Beside all strategies together. Efficiency is 1/(variance × cost), with its 95 % interval; the cost counts rays. Every set listed can make every kind of path, so the picture keeps its mean whichever is used; the weights are shared among its members.", "与全部策略相比。效率 = 1/（方差 × 成本），附 95 % 区间；成本按光线数计算。列出的每个集合都能生成所有种类的路径，因此无论选用哪个，图像的均值不变；权重由其成员分享。";
    Efficiency: "efficiency", "效率";
    Variance: "variance", "方差";
    Cost: "cost", "成本";
    Strategies: "strategies", "策略";
    Use: "Use", "采用";
    HelpUse: "These strategies take part, the others are removed; rendering starts again", "只有这些策略参与，其余被移除；重新开始渲染";
    Best: "Suggested: {}.", "建议：{}。";
    NoneBetter: "Suggested: all strategies. No other set is surely better by a tenth.", "建议：全部策略。没有其他集合确定地好出十分之一。";
    All: "all strategies", "全部策略";
    WithLightSubpaths: "{}; {} light subpaths", "{}；{} 条光源子路径";
    Inner: "inner connections", "内部连接";
    NoThread: "The pilot run could not be started: {}", "无法开始试运行：{}";
}
