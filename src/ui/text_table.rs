//! The table of texts: key, English, Simplified Chinese. Chinese terms are those of the seed notes (双向路径追踪, 连接边, …).

use super::text::Lang;

macro_rules! texts {
    ($($key:ident: $en:literal, $zh:literal;)*) => {
        /// A text of the window.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[allow(missing_docs)]
        pub enum Text { $($key,)* }

        impl Text {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$key,)*];

            /// The text in a language.
            pub const fn in_language(self, lang: Lang) -> &'static str {
                match (self, lang) { $((Self::$key, Lang::En) => $en, (Self::$key, Lang::Zh) => $zh,)* }
            }
        }
    };
}

texts! {
    // Roles of strategies.
    RoleEyeHitsLight: "eye path hits light", "视线命中光源";
    RoleNextEvent: "next event", "直接采样光源";
    RoleConnect: "connect {}+{}", "连接 {}+{}";
    RoleLightTracer: "light tracer", "光源追踪";
    RoleLightHitsLens: "light hits lens", "光线命中镜头";
    HelpEyeHitsLight: "The eye subpath runs into a light by itself (s = 0): good for large lights and mirrors.", "视线子路径自己撞到光源（s = 0）：适合大光源和镜面反射。";
    HelpNextEvent: "The end of the eye subpath is joined to a point chosen on a light (s = 1): good for small lights.", "视线子路径的末端与光源上选取的一点相连（s = 1）：适合小光源。";
    HelpConnect: "The ends of both subpaths are joined (s ≥ 2, t ≥ 2): good where light arrives over detours.", "两条子路径的末端相连（s ≥ 2，t ≥ 2）：适合经多次反射才到达的光。";
    HelpLightTracer: "The end of the light subpath is joined to the lens (t = 1): good for caustics. It lands on whichever pixel sees it.", "光源子路径的末端与镜头相连（t = 1）：适合焦散。贡献落在看得到它的像素上。";
    HelpLightHitsLens: "The light subpath runs into the lens by itself (t = 0): needs a lens with area.", "光源子路径自己撞到镜头（t = 0）：需要有面积的薄透镜。";
    // Top bar.
    Scene: "Scene", "场景";
    HelpScene: "Choose a built-in scene, type a path, or drop a .glb or .gltf file on the window.", "选择内置场景、输入路径，或把 .glb / .gltf 文件拖到窗口上。";
    ScenePath: "Or a .glb / .gltf file:", "或 .glb / .gltf 文件：";
    ScenePathHint: "path to a file", "文件路径";
    Open: "Open", "打开";
    Integrator: "Strategies", "采样策略";
    HelpIntegrator: "Which strategies take part. Those that do share the weights among themselves.", "哪些采样策略参与计算；权重只在参与者之间分配。";
    IntegratorAll: "BDPT", "BDPT";
    IntegratorPt: "PT", "PT";
    IntegratorLt: "LT", "LT";
    IntegratorSome: "some", "部分";
    HelpIntegratorAll: "Bidirectional path tracing: all of them.", "双向路径追踪：全部策略。";
    HelpIntegratorPt: "Path tracing: s ≤ 1.", "路径追踪：s ≤ 1。";
    HelpIntegratorLt: "Light tracing: t ≤ 1.", "光源追踪：t ≤ 1。";
    Heuristic: "Weights", "权重";
    HelpHeuristic: "How strategies that can make the same path share it (multiple importance sampling).", "能生成同一条路径的各策略如何分配权重（多重重要性采样）。";
    Power: "power", "幂启发式";
    Balance: "balance", "平衡启发式";
    Max: "max", "最大值";
    Cutoff: "cutoff", "截断";
    Uniform: "uniform", "均匀";
    HelpPower: "w = p^β / Σ p^β: like balance, but it trusts the best strategy more.", "w = p^β / Σ p^β：与平衡启发式类似，但更信任最好的策略。";
    HelpBalance: "w = p / Σ p: every strategy in proportion to its density.", "w = p / Σ p：按各策略的概率密度分配。";
    HelpMax: "The densest strategy takes all.", "概率密度最大的策略独占。";
    HelpCutoff: "Strategies below A times the densest get nothing, the rest share in balance.", "密度低于最大值 A 倍的策略不计，其余按平衡启发式分配。";
    HelpUniform: "Equal shares for all that can make the path: the mean of the strategies, with the worst one's noise.", "所有能生成该路径的策略平分：等于取平均，噪声由最差者决定。";
    HelpBeta: "β, the exponent of the power heuristic", "β，幂启发式的指数";
    HelpA: "A, the threshold of the cutoff heuristic", "A，截断启发式的阈值";
    HelpK: "K, the most edges a path may have, over both subpaths together (1 to 64)", "K，路径的最大边数，两条子路径合计（1 到 64）";
    Seed: "Seed", "种子";
    HelpSeed: "Seed of the random numbers: the same seed gives the same paths", "随机数种子：种子相同则路径相同";
    Roulette: "Roulette", "轮盘赌";
    HelpRoulette: "Russian roulette ends subpaths at dark surfaces early. The mean stays the same.", "俄罗斯轮盘赌让子路径在暗表面提前结束；期望值不变。";
    FilmSize: "Film", "画幅";
    HelpFilmSize: "Size of the image in pixels", "图像尺寸（像素）";
    Pause: "Pause", "暂停";
    Resume: "Resume", "继续";
    Restart: "Restart", "重新开始";
    HelpRestart: "Throw the samples away and start again from sample 0.", "丢弃已有采样，从第 0 个采样重新开始。";
    LightTheme: "Light", "浅色";
    DarkTheme: "Dark", "深色";
    HelpTheme: "Switch between the dark and the light theme", "切换深色与浅色主题";
    HelpLanguage: "Switch the window to Chinese", "把界面切换为英文（English）";
    Inspector: "Inspector", "检查器";
    Pyramid: "Pyramid", "策略金字塔";
    HelpTogglePanel: "Show or hide this panel", "显示或隐藏此面板";
    // Messages.
    Problem: "Problem", "问题";
    Note: "Note", "提示";
    Dismiss: "Dismiss", "关闭";
    LoaderDied: "{}: reading this scene failed unexpectedly; please report the file", "{}：读取场景时意外失败，请反馈该文件";
    DropHere: "Drop a .glb or .gltf file to open it", "松开鼠标以打开 .glb 或 .gltf 文件";
    NotAScene: "{}: only .glb and .gltf files can be opened", "{}：只能打开 .glb 和 .gltf 文件";
    // Image.
    ImageName: "Image, pixel {}, {} selected", "图像，已选像素 {}, {}";
    Exposure: "Exposure", "曝光";
    HelpExposure: "Brightness of the picture in stops; the numbers stay as they are", "画面亮度（档）；数值不变";
    ToneMapping: "Tone", "色调";
    HelpToneMapping: "How radiance beyond the screen's white is shown", "超出屏幕白色的辐射亮度如何显示";
    Pixel: "Pixel", "像素";
    HelpPixel: "The selected pixel, from the top left", "所选像素，从左上角起";
    Fit: "Fit", "适应";
    Show: "Show", "显示";
    HelpShow: "What is drawn over the image", "图像上叠加显示的内容";
    ShowNames: "names of vertices", "顶点名称";
    ShowLegend: "legend", "图例";
    Maximise: "Maximise", "最大化";
    HelpMaximise: "Give this panel the window, or give it back", "让此面板占满窗口，或恢复";
    LegendEye: "eye subpath z₀ z₁ …", "视线子路径 z₀ z₁ …";
    LegendLight: "light subpath y₀ y₁ …", "光源子路径 y₀ y₁ …";
    LegendConnection: "connection", "连接边";
    LegendBlocked: "blocked connection", "被遮挡的连接边";
    LegendSelected: "selected strategy, vertex", "所选策略与顶点";
    LegendSplat: "lands on this pixel (t = 1)", "贡献落在此像素（t = 1）";
    LegendFresh: "fresh light point y₀' (s = 1)", "新取的光源点 y₀'（s = 1）";
    HelpSplat: "This strategy's contribution lands on this pixel, not on the selected one.", "该策略的贡献落在这个像素上，而不是所选像素。";
    // Status bar.
    Loading: "Loading the scene …", "正在载入场景……";
    Waiting: "Waiting for the first picture …", "正在等待第一幅图像……";
    Backend: "{} · {} threads", "{} · {} 线程";
    HelpBackend: "What renders the image", "由谁渲染图像";
    SamplesSoFar: "{} samples per pixel", "每像素 {} 个采样";
    HelpSamples: "Samples so far: pairs of a light and an eye subpath per pixel", "已完成的采样：每像素的光源与视线子路径对数";
    FirstPass: "first pass: {} %", "第一遍：{} %";
    HiddenCount: "{} hidden", "隐藏 {} 个";
    RemovedCount: "{} removed", "移除 {} 个";
    HelpLeftOut: "Hidden strategies are left out of the image, whose light is then missing. Removed ones do not run; the others share their weight.", "隐藏的策略不计入图像，因此缺少它们的光；移除的策略不再运行，权重由其余策略分配。";
    Paused: "paused", "已暂停";
    Speed: "{} Mpairs/s", "{} 百万对/秒";
    HelpSpeed: "Million pairs of a light and an eye subpath per second", "每秒完成的子路径对（百万）";
    UiTime: "window {} ms", "界面 {} 毫秒";
    HelpUiTime: "Time the window needs for one of its own frames", "界面绘制一帧所用的时间";
    NotesCount: "notes on the scene: {}", "场景说明：{} 条";
    NonFinite: "{} values were not finite and were left out", "有 {} 个非有限值被舍弃";
    WhichSample: "pixel {}, {} · sample {} · seed {}", "像素 {}, {} · 采样 {} · 种子 {}";
    PixelValue: "RGB", "RGB";
    HelpPixelValue: "Mean radiance of the selected pixel so far: red, green, blue; W m⁻² sr⁻¹", "所选像素目前的平均辐射亮度：红、绿、蓝；W m⁻² sr⁻¹";
    // Inspector.
    InspectorTitle: "How pixel {}, {} was made", "像素 {}, {} 是怎样得到的";
    Sample: "Sample", "采样";
    Previous: "Previous", "上一个";
    Next: "Next", "下一个";
    FeasibleCount: "{} of {} strategies carry light", "{} / {} 个策略携带光";
    SampleAdds: "This sample adds {} to this pixel", "该采样为此像素贡献 {}";
    HelpSampleAdds: "RGB, W m⁻² sr⁻¹: the sum of the weighted contributions that land on this pixel, hidden strategies included. The pixel is the mean over all samples, and gets light tracer contributions from other pixels' samples, too.", "RGB，W m⁻² sr⁻¹：落在此像素上的加权贡献之和，包括隐藏的策略。像素值是所有采样的平均，并且还会收到其他像素采样的光源追踪贡献。";
    NoRecord: "Click a pixel of the image.", "请点击图像中的一个像素。";
    TabStrategies: "Strategies", "采样策略";
    TabPath: "Path", "路径";
    TabSplits: "Splits", "拆分";
    HelpTabStrategies: "Every way to join the two subpaths of this sample", "连接该采样两条子路径的所有方式";
    HelpTabPath: "The vertices of the selected strategy's path, with densities", "所选策略的路径顶点及概率密度";
    HelpTabSplits: "The same path under every strategy that could have made it", "同一条路径在每个可能生成它的策略下";
    SortBy: "Order:", "排序：";
    SortLength: "path length", "路径长度";
    SortWeight: "weight", "权重";
    SortContribution: "contribution", "贡献";
    HeadStrategy: "strategy (s,t)", "策略 (s,t)";
    HeadWeight: "weight w", "权重 w";
    HeadContribution: "contribution", "贡献";
    HeadLandsAt: "lands at", "落点";
    HelpHeadContribution: "Luminance of the weighted contribution w C*, W m⁻² sr⁻¹; the square shows its colour", "加权贡献 w C* 的亮度，W m⁻² sr⁻¹；方块表示其颜色";
    LengthGroup: "paths of {} edges", "{} 条边的路径";
    SpokenWeight: "weight {}", "权重 {}";
    SpokenHidden: ", hidden", "，已隐藏";
    NumberWeight: "weight w", "权重 w";
    NumberContribution: "contribution w C* (RGB)", "贡献 w C*（RGB）";
    NumberUnweighted: "unweighted C*", "未加权 C*";
    NumberConnection: "connection term c", "连接项 c";
    NumberDensity: "density p", "概率密度 p";
    NumberRaster: "lands at (pixels)", "落点（像素）";
    PathOfLength: "path of {} edges", "{} 条边的路径";
    NotInRecord: "This sample has no such strategy.", "该采样没有这个策略。";
    WalkFull: "full path", "完整路径";
    WalkLight: "light subpath", "光源子路径";
    WalkEye: "eye subpath", "视线子路径";
    FreshPoint: "fresh light point", "新取的光源点";
    KindLens: "lens", "镜头";
    KindLight: "light", "光源";
    KindSurface: "surface", "表面";
    Emitter: "emits", "发光";
    HelpDelta: "A mirror or glass: the sampled component is a Dirac, its density a factor of it", "镜面或玻璃：被采样的分量是狄拉克函数，密度是它的系数";
    Position: "position", "位置";
    HelpPosition: "Position in the file's coordinates", "文件坐标系中的位置";
    HelpAlpha: "Throughput of its subpath up to here: f over density", "子路径到此为止的吞吐量：f 除以概率密度";
    HelpSurvival: "Probability of surviving Russian roulette here", "在此通过俄罗斯轮盘赌的概率";
    HelpPLight: "Density of this vertex by a light subpath that comes through the vertex before it", "光源子路径经前一顶点到达此顶点的概率密度";
    HelpPEye: "Density of this vertex by an eye subpath that comes through the vertex after it", "视线子路径经后一顶点到达此顶点的概率密度";
    PdfFwd: "p forward", "p 正向";
    HelpPdfFwd: "Density of this vertex by its own subpath", "此顶点在自身子路径中的概率密度";
    PdfRev: "p reverse", "p 反向";
    HelpPdfRev: "Density of this vertex by a subpath from the other end", "此顶点在另一端子路径中的概率密度";
    ConnectionHere: "connection edge, c = {}", "连接边，c = {}";
    EndMaxEdges: "It ends here: K allows no further vertex.", "到此结束：K 不允许更多顶点。";
    EndEscaped: "It ends here: its last ray left the scene.", "到此结束：最后一条光线离开了场景。";
    EndRoulette: "It ends here: Russian roulette.", "到此结束：俄罗斯轮盘赌。";
    EndAbsorbed: "It ends here: its last vertex scatters nothing further.", "到此结束：最后一个顶点不再散射。";
    EndNotNeeded: "It ends here: no strategy in use needs more.", "到此结束：没有策略需要更多顶点。";
    SplitsIntro: "This very path, as each strategy would make it: density p (log scale) and weight w.", "同一条路径由各策略生成时：概率密度 p（对数刻度）与权重 w。";
    SplitsScale: "Bar of p: log scale over the range of this path, the least dense keeps a tenth. p is per product area (m⁻² for each vertex). Bar of w: linear, 0 to 1.", "p 的条：按此路径的范围取对数刻度，密度最小者占十分之一；p 以面积乘积为测度（每个顶点 m⁻²）。w 的条：线性，0 到 1。";
    NoSplits: "Splits are shown for strategies that carry light: choose one in the table.", "仅对携带光的策略显示拆分：请在表中选择一个。";
    HelpWeightSum: "The weights of all strategies that can make this path sum to one.", "所有能生成该路径的策略，权重之和为一。";
    SplitPinhole: "a pinhole has no area to be hit", "针孔没有面积，无法命中";
    SplitLight: "the light has no extent to be hit", "光源没有面积，无法命中";
    SplitDirac: "a mirror or glass at its connection edge", "连接边的一端是镜面或玻璃";
    SplitZero: "its walks never go this way: density is zero", "它的随机游走不会这样走：概率密度为零";
    SplitRemoved: "the strategy was removed", "该策略已被移除";
    ShortLightTooShort: "light subpath too short", "光源子路径太短";
    ShortEyeTooShort: "eye subpath too short", "视线子路径太短";
    ShortLightDirac: "light end is a mirror or glass", "光源侧末端是镜面或玻璃";
    ShortEyeDirac: "eye end is a mirror or glass", "视线侧末端是镜面或玻璃";
    ShortNotOnALight: "does not end on a light", "末端不在光源上";
    ShortBackOfLight: "light does not shine there", "光源不照向此处";
    ShortEyeAtInfinity: "eye end is the environment", "视线侧末端是环境";
    ShortMissesLens: "misses the lens", "未命中镜头";
    ShortLightNotShown: "light without extent: not shown", "光源无面积：不显示";
    ShortBehindCamera: "behind the camera", "在相机后方";
    ShortOutsideFilm: "outside the picture", "在画面之外";
    ShortLightBlack: "light end scatters nothing there", "光源侧末端不向此散射";
    ShortEyeBlack: "eye end scatters nothing there", "视线侧末端不向此散射";
    ShortDegenerate: "degenerate edge", "退化的连接边";
    ShortBlocked: "blocked", "被遮挡";
    ShortNoLight: "no light in the scene", "场景中没有光源";
    // Pyramid.
    HelpPyramid: "A row per path length, a cell per strategy (s,t): its weighted image. The cells add up to the image above.", "每行一个路径长度，每格一个策略 (s,t)：其加权图像。各格相加即为上方图像。";
    ShowAll: "Show all", "全部显示";
    HelpShowAll: "Every strategy counts in the image", "所有策略都计入图像";
    HideAll: "Hide all", "全部隐藏";
    HelpHideAll: "Leave every strategy out of the image, then add them one by one", "先把所有策略移出图像，再逐个加回";
    OnlySelected: "Only selected", "仅所选";
    HelpOnlySelected: "Show the selected strategy alone", "只显示所选策略";
    RestoreAll: "Restore removed", "恢复移除";
    HelpRestoreAll: "Run all strategies again. Rendering restarts.", "重新启用所有策略；渲染将重新开始。";
    Families: "Families", "类别";
    FamilyConnect: "connect", "连接";
    HelpFamily: "Click: show or hide this family. Shift+click: show it alone.", "点击：显示或隐藏该类。Shift+点击：只显示该类。";
    Brightness: "Brightness", "亮度";
    GainEach: "each cell auto", "逐格自动";
    GainSame: "same exposure", "同一曝光";
    HelpGainEach: "Every cell is made as bright as it can be: compare shapes, not amounts", "每格尽量调亮：比较形状而非数量";
    HelpGainSame: "All cells have the image's exposure: compare amounts", "各格与图像曝光相同：比较数量";
    CellSize: "Size", "大小";
    HelpRow: "k, the number of edges of these paths; s + t = k + 1", "k，这些路径的边数；s + t = k + 1";
    HelpShare: "Share of the image's energy", "占图像能量的份额";
    HideRow: "hide", "隐藏";
    ShowRow: "show", "显示";
    OnlyRow: "only", "仅此";
    RowName: "paths of {} edges: {}", "{} 条边的路径：{}";
    CellRemoved: "removed", "已移除";
    CellHidden: "hidden", "已隐藏";
    CellWaiting: "waiting for the first picture", "等待第一幅图像";
    CellNothing: "no contribution yet", "尚无贡献";
    ShareOfEnergy: "{} of the image's energy", "占图像能量的 {}";
    Hide: "hide", "隐藏";
    Remove: "remove", "移除";
    HelpHide: "Leave it out of the sum, at once. The other weights stay, so its light is missing from the image.", "立即从总和中略去。其他权重不变，因此图像中缺少它的光。";
    HelpRemove: "Do not run it. Rendering restarts; the weights are shared among the rest, so the image stays right where others can make the same paths.", "不再运行它。渲染重新开始；权重由其余策略分配，凡其他策略能生成同样路径之处图像仍然正确。";
    // Keys.
    HelpTitle: "Keys", "快捷键";
    HelpMouse: "Click the image to pick a pixel. Drag to move it, turn the wheel or pinch to zoom around the cursor. Drop a .glb or .gltf file to open it. Tab reaches everything.", "点击图像选取像素；拖动平移，滚轮或双指缩放；拖入 .glb 或 .gltf 文件即可打开；Tab 键可到达所有控件。";
    KeyNudge: "Move the selected pixel by one; with Shift by ten", "所选像素移动一格；按住 Shift 移动十格";
    KeySample: "Next sample, previous sample", "下一个采样，上一个采样";
    KeyStrategy: "Strategies of the current path length", "当前路径长度的各个策略";
    KeyVertex: "Next vertex of the selected path, previous vertex", "所选路径的下一个顶点，上一个顶点";
    KeyHide: "Hide or show the selected strategy", "隐藏或显示所选策略";
    KeyExposure: "Exposure up, down by half a stop", "曝光增加、减少半档";
    KeyFit: "Fit the image to its panel", "让图像适应面板";
    KeyReset: "Reset the view: fit, exposure 0, sRGB", "重置视图：适应、曝光 0、sRGB";
    KeyPause: "Pause or resume rendering", "暂停或继续渲染";
    KeyHelp: "This list of keys", "显示此快捷键列表";
}
