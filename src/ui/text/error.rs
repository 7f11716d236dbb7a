//! The texts of the page about error: the reference, the curves, the table.

texts! { ErrorText;
    Tab: "Error", "误差";
    HelpTab: "How far the image is from a reference: against samples and time, beside PT and LT, strategy by strategy", "图像与参考图的差距：随采样数与时间的变化，与 PT、LT 对照，并可逐策略查看";
    Title: "How far from right?", "误差有多大？";
    Intro: "relMSE = mean over pixels and channels of (a − b)²/(b² + 0.01); a is the image with what is hidden, b the reference. Without bias it falls in inverse proportion to the samples: slope −1.", "relMSE = (a − b)²/(b² + 0.01) 的像素与通道平均；a 为图像（含隐藏的策略），b 为参考图。无偏时它与采样数成反比：斜率 −1。";
    NoScene: "There is no image to measure yet.", "尚无可测量的图像。";
    // The reference.
    Reference: "reference", "参考图";
    Render: "Render a reference in the background", "在后台渲染参考图";
    HelpRender: "All strategies with another seed, of the same scene, camera, film and K. It takes turns with the image: four of its own for each one of the image, until it is held.", "使用全部策略和另一个种子，场景、相机、画幅与 K 相同。它与图像轮流渲染：图像每一轮，参考图四轮，直到暂停参考图。";
    Load: "Load a reference …", "载入参考图 …";
    Hold: "Hold the reference", "暂停参考图";
    HelpHold: "It is good enough: the image has its turns.", "参考图已足够好：把轮次让给图像。";
    GoOn: "Go on with the reference", "继续渲染参考图";
    LetGo: "Let it go", "放弃参考图";
    HelpLetGo: "Measures nothing any more, and frees the memory.", "不再测量，并释放内存。";
    Coming: "reference: first pass …", "参考图：第一遍……";
    Rendered: "reference: {} spp, {} s; its own noise: relMSE {}", "参考图：{} spp，{} 秒；自身噪声：relMSE {}";
    Given: "reference: {}; its own noise is not known", "参考图：{}；自身噪声未知";
    Gone: "Scene, camera, lens, film size or K has changed: the reference was of something else, and was let go. Render or load another.", "场景、相机、镜头、画幅或 K 已改变：参考图已不再适用，因此被放弃。请重新渲染或载入。";
    None: "There is no reference yet: render one, or load one.", "尚无参考图：请渲染或载入。";
    Refused: "This takes {} MiB, and at most {} MiB are used for it here: choose a smaller film or fewer edges, or do without the strategies or PT and LT.", "需要 {} MiB，此处最多使用 {} MiB：请减小画幅或边数，或不测量各策略或 PT 与 LT。";
    Memory: "{} MiB of at most {} MiB", "占用 {} MiB，上限 {} MiB";
    HelpMemory: "Films of the reference and of PT and LT, and the pictures at 1, 2, 4, … samples per pixel, which are measured again whenever the reference has become better", "参考图与 PT、LT 的画面，以及在 1、2、4…… spp 时的图像；参考图改进后会重新测量它们";
    // Views.
    Peek: "Hold Shift over the image: the reference.", "在图像上按住 Shift：查看参考图。";
    ViewSigned: "Signed difference", "有符号差异";
    HelpViewSigned: "Image less reference: orange where the image is brighter, blue where it is darker; the scale is drawn beside it.", "图像减参考图：橙色处图像较亮，蓝色处较暗；色标画在一旁。";
    ViewRelative: "Relative error", "相对误差";
    HelpViewRelative: "(a − b)²/(b² + 0.01) of every pixel in false colour (Viridis); the scale is drawn beside it.", "每个像素的 (a − b)²/(b² + 0.01)，伪彩色（Viridis）；色标画在一旁。";
    // What is measured.
    EqualSamples: "Equal samples", "相同采样数";
    HelpEqualSamples: "PT and LT get as many samples per pixel as the image; error against samples.", "PT 与 LT 的每像素采样数与图像相同；误差随采样数变化。";
    EqualTime: "Equal time", "相同时间";
    HelpEqualTime: "PT and LT get as much time as the image; error against time. It is the time of a rendering's own turns, by the clock: what else renders meanwhile is not in it, what else the machine does is.", "PT 与 LT 的用时与图像相同；误差随时间变化。时间为各渲染自己轮次的时钟时间：不含此间其他渲染的时间，但包含机器上其他工作的影响。";
    Rivals: "PT and LT", "PT 与 LT";
    HelpRivals: "Renders a path tracer {s ≤ 1} and a light tracer {t ≤ 1} with the same budget, in turns with the image.", "以同样的预算渲染路径追踪 {s ≤ 1} 与光源追踪 {t ≤ 1}，与图像轮流进行。";
    Strategies: "Strategy by strategy", "逐策略";
    HelpStrategies: "Renders the reference anew with an image for each strategy, and measures every strategy at 1, 2, 4, … samples per pixel: the mean of (C − R)²/(b² + 0.01) of its weighted images in image and reference, less the reference's part of it. That is what the strategy's own noise adds to relMSE; their covariances are left out.", "重新渲染带有各策略图像的参考图，并在 1、2、4…… spp 时测量每个策略：图像与参考图中其加权图像的 (C − R)²/(b² + 0.01) 的平均，减去参考图的部分。即该策略自身噪声对 relMSE 的贡献，不含策略间的协方差。";
    OtherWeights: "The image weighs its strategies otherwise than the reference, so they cannot be measured: let the reference go and render another.", "图像的策略权重与参考图不同，因此无法逐策略测量：请放弃参考图并重新渲染。";
    Trimmed: "Without the 0.1 % worst pixels", "略去最差的 0.1% 像素";
    HelpTrimmed: "Draws the trimmed error: fireflies decide it less.", "绘制截尾误差：受亮斑影响较小。";
    Anew: "Image anew", "图像重新开始";
    HelpAnew: "Starts the image over, so that its curve begins at the first sample, too. The reference stays.", "图像重新开始渲染，使其曲线也从第一个采样开始；参考图保留。";
    // The curves.
    Waiting: "Nothing is measured yet: the first points come with the first passes.", "尚无测量结果：首批数据点在前几遍渲染后出现。";
    AlongSamples: "samples per pixel", "每像素采样数";
    AlongTime: "render time of its own turns, s", "自身轮次的渲染时间，秒";
    Up: "relMSE, no unit", "relMSE，无单位";
    UpTrimmed: "relMSE without the 0.1 % worst pixels, no unit", "略去最差 0.1% 像素的 relMSE，无单位";
    Plot: "Plot of error: {}", "误差曲线：{}";
    Slope: "slope {}", "斜率 {}";
    HelpSlope: "Least squares of log relMSE, less the reference's noise, over log samples (or time), where the error is more than twice that noise; −1 without bias.", "对 log relMSE（减去参考图噪声）关于 log 采样数（或时间）作最小二乘，仅取误差大于该噪声两倍处；无偏时为 −1。";
    Guide: "slope −1", "斜率 −1";
    Floor: "the reference's noise", "参考图噪声";
    HelpFloor: "What is measured holds the reference's own noise: near this line it says little, below it nothing.", "测得的误差包含参考图自身的噪声：接近此线时意义不大，低于它则毫无意义。";
    Noisy: "The reference's own noise is {} of the image's error: render it further.", "参考图自身的噪声占图像误差的 {}：请继续渲染参考图。";
    Lost: "{}: no strategy of it can make the paths {}. Their light is missing, so that its error stays above what they would bring.", "{}：其任何策略都无法生成路径 {}。因缺少它们的光，其误差不会继续下降。";
    // The table.
    AtSamples: "At equal samples: {} spp each", "相同采样数：各 {} spp";
    AtTime: "At equal time: {} s each (to 5 %)", "相同时间：各 {} 秒（差 5% 以内）";
    NearTime: "Not yet at equal time: nearest to {} s", "尚未达到相同时间：取最接近 {} 秒处";
    Alone: "The image now", "当前图像";
    Method: "method", "方法";
    Samples: "spp", "spp";
    Seconds: "s", "秒";
    HelpSeconds: "Time of its own turns, by the clock, s", "自身轮次的时钟时间，秒";
    RelMse: "relMSE", "relMSE";
    HeadTrimmed: "trimmed", "截尾";
    HelpHeadTrimmed: "relMSE without the 0.1 % worst pixels", "略去最差 0.1% 像素的 relMSE";
    Efficiency: "1/(relMSE·s)", "1/(relMSE·秒)";
    HelpEfficiency: "Efficiency: 1/(relMSE · seconds), s⁻¹; without bias it does not depend on the samples. Higher is better.", "效率：1/(relMSE · 秒)，s⁻¹；无偏时与采样数无关。越高越好。";
    Image: "{} (image)", "{}（图像）";
    Row: "{}: {} samples per pixel, {} s, relMSE {}, trimmed {}, efficiency {} per second", "{}：每像素 {} 个采样，{} 秒，relMSE {}，截尾 {}，效率每秒 {}";
    RowStrategy: "{}: adds {} to relMSE at {} samples per pixel", "{}：在每像素 {} 个采样时为 relMSE 贡献 {}";
    HeadStrategies: "What each strategy's noise adds to relMSE", "各策略噪声对 relMSE 的贡献";
}
