//! The texts of the inspector's pages: the vertex card, the splits, the search for samples.

texts! { InspectText;
    TabPixel: "Pixel", "像素";
    HelpTabPixel: "Which strategies made this pixel bright, over all its samples", "此像素的亮度由哪些策略贡献（全部采样）";
    PixelIntro: "What each strategy adds to this pixel: its mean over {} samples, largest first; share and luminance.", "各策略对此像素的贡献：{} 个采样的均值，从大到小；占比与亮度。";
    PixelRest: "{} others have brought no light here so far, or are hidden or removed.", "其余 {} 个策略至今没有为此处带来光，或已隐藏、移除。";
    PixelMean: "mean contribution {}", "平均贡献 {}";
    PixelNotYet: "The first pass is under way.", "第一遍渲染尚未完成。";
    // Vertex card.
    CopyVertex: "Copy JSON", "复制 JSON";
    HelpCopyVertex: "Copy the selected vertex as it stands in inspect --json", "以 inspect --json 中的形式复制所选顶点";
    VertexOf: "vertex {} of {} … {}", "顶点 {}（{} … {}）";
    HelpNormalG: "Geometric normal (unit); of the lens the camera's axis, of a spot its axis", "几何法线（单位向量）；镜头处为相机轴，聚光灯处为其轴";
    HelpNormalS: "Shading normal (unit): interpolated, or from a normal map", "着色法线（单位向量）：由插值或法线贴图得到";
    Angle: "n_g to n_s", "n_g 与 n_s";
    HelpAngle: "Angle between the geometric and the shading normal, degrees", "几何法线与着色法线的夹角（度）";
    GgxAlpha: "α of GGX", "GGX 的 α";
    HelpGgxAlpha: "Width of the microfacet lobe: roughness squared, at least 0.001", "微表面波瓣的宽度：粗糙度的平方，至少 0.001";
    HelpIor: "Index of refraction, inside over outside", "折射率（内 / 外）";
    CoatF0: "coat F₀", "涂层 F₀";
    HelpCoatF0: "What the coat reflects at normal incidence", "涂层在垂直入射时的反射率";
    HelpRadiance: "What the light emits here: radiance, RGB, W m⁻² sr⁻¹", "光源在此处的发射辐射亮度，RGB，W m⁻² sr⁻¹";
    HelpIntensity: "What the light emits: its greatest intensity, RGB, W sr⁻¹", "光源的最大发光强度，RGB，W sr⁻¹";
    HelpIrradiance: "What the light brings: irradiance on a plane that faces it, RGB, W m⁻²", "该光在正对平面上的辐照度，RGB，W m⁻²";
    Edge: "{} to {}", "{} 到 {}";
    HelpEdge: "The edge between the two: its length and its unit direction", "两顶点之间的边：长度与单位方向";
    Infinite: "from infinity", "来自无穷远";
    HelpGeometry: "Geometry term of this edge without V: cosines over squared distance, m⁻². At a point light without its cosine; from infinity |cosθ|, a pure number.", "此边的几何项（不含 V）：余弦之积除以距离平方，m⁻²。点光源处不计余弦；来自无穷远时为 |cosθ|，无量纲。";
    NoGeometry: "the two coincide", "两点重合";
    // What happens at a vertex.
    WordsLens: "The path meets the lens here.", "路径在此到达镜头。";
    WordsPinhole: "The path meets the pinhole here: a point that only eye subpaths start from.", "路径在此到达针孔：只有视线子路径能从这一点出发。";
    WordsArea: "Light leaves an area light here, on its shining side in proportion to the cosine.", "光在此离开面光源，按余弦分布射向发光的一侧。";
    WordsPoint: "Light leaves a point here, the same in all directions.", "光在此离开一个点，各方向相同。";
    WordsSpot: "Light leaves a point here, inside a cone.", "光在此离开一个点，限于锥内。";
    WordsDirectional: "Parallel light comes from infinitely far away.", "平行光来自无穷远。";
    WordsEnvironment: "Light comes from the environment, infinitely far away.", "光来自无穷远的环境。";
    WordsUnlit: "Emits its own colour and scatters nothing.", "发出自身颜色的光，不散射。";
    WordsLambert: "Diffuse: scatters evenly into all directions on the side the light came from, f = ρ/π.", "漫反射：向光来的一侧各方向均匀散射，f = ρ/π。";
    WordsMirror: "Mirror: light leaves in the mirror direction alone, so nothing can be connected here.", "镜面：光只沿镜面方向离开，因此这里无法连接。";
    WordsRefracted: "Glass: the path passes through the boundary and is refracted.", "玻璃：路径穿过边界并发生折射。";
    WordsReflected: "Glass: the path is reflected at the boundary.", "玻璃：路径在边界处反射。";
    WordsStraight: "Thin glass: the path passes straight through.", "薄玻璃：路径直接穿过。";
    WordsThinReflected: "Thin glass: the path is reflected.", "薄玻璃：路径被反射。";
    WordsGlassEnd: "Glass: reflects or refracts into single directions, so nothing can be connected here.", "玻璃：只向个别方向反射或折射，因此这里无法连接。";
    WordsMetal: "Rough metal: scatters into a GGX lobe around the mirror direction.", "粗糙金属：向镜面方向附近的 GGX 波瓣散射。";
    WordsCoat: "Coated: a GGX lobe around the mirror direction over a diffuse base, mixed with metal.", "涂层：漫反射基底之上的 GGX 波瓣，并与金属混合。";
    WordsShines: "It lies on a light: an eye subpath that ends here has hit it.", "它位于光源上：在此结束的视线子路径命中了光源。";
    // Splits.
    BarsShow: "Bars:", "条形：";
    BarsDensity: "density", "密度";
    BarsWeight: "weight", "权重";
    BarsContribution: "contribution", "贡献";
    HelpBars: "Which quantity the bars show; the numbers of all three stand beside them", "条形表示哪个量；三者的数值都列在旁边";
    HeadDensity: "log₁₀ p", "log₁₀ p";
    HeadWeight: "w", "w";
    HeadContribution: "w C*", "w C*";
    HelpHeads: "log₁₀ of the density p, the weight w, and the luminance of the contribution w C* = w f/(n p) in W m⁻² sr⁻¹: what this strategy adds whenever it makes this very path", "密度 p 的 log₁₀、权重 w，以及贡献 w C* = w f/(n p) 的亮度（W m⁻² sr⁻¹）：该策略每次生成这条路径时所增加的量";
    WhatIf: "What if:", "假设：";
    HelpWhatIf: "Weigh this path by another heuristic: at once, and the image goes on as it is", "以另一种启发式为此路径重新加权：立即生效，图像不受影响";
    WhatIfHeuristic: "What-if weights", "假设的权重";
    WhatIfBeta: "What-if β", "假设的 β";
    WhatIfCutoff: "What-if A", "假设的 A";
    ApplyWhatIf: "Apply to the image", "应用到图像";
    HelpApplyWhatIf: "Render with these weights; rendering restarts", "以此权重渲染；渲染将重新开始";
    ForgetWhatIf: "As in the image", "与图像相同";
    HelpForgetWhatIf: "Back to the weights the image is rendered with", "恢复图像所用的权重";
    Then: "what if", "假设";
    SpokenSplit: "{}: weight {}", "{}: 权重 {}";
    // Search.
    FindNext: "Next with light", "下一个有光的采样";
    HelpFindNext: "Go to the next sample of this pixel in which the selected strategy carries light", "转到此像素中所选策略携带光的下一个采样";
    FindBrightest: "Brightest of 256", "256 个中最亮的";
    HelpFindBrightest: "Go to the sample that adds most to this pixel among the next 256", "转到后续 256 个采样中对此像素贡献最大的一个";
    StopSearch: "Stop", "停止";
    Searching: "searching, sample {} …", "正在查找，采样 {}……";
    FoundNone: "In none of the next {} samples of this pixel does {} carry light.", "此像素后续 {} 个采样中，{} 均不携带光。";
    AllDark: "None of the next {} samples adds light to this pixel.", "此像素后续 {} 个采样均无贡献。";
    // Marks in the image.
    MarkVertex: "{}: click to select it", "{}：点击选择";
    MarkStrategy: "{}: click to select it", "{}：点击选择";
    HelpMark: "With Ctrl held, a click selects the pixel below instead.", "按住 Ctrl 点击则选择其下的像素。";
}
