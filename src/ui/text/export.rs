//! The texts of saving.

texts! { ExportText;
    Save: "Save", "保存";
    HelpSave: "Save the picture, the strategies' images or this sample into a file", "把图像、各策略的图像或此采样保存为文件";
    PictureAsSeen: "Picture as shown (PNG)", "所见图像（PNG）";
    HelpPictureAsSeen: "Eight bits: what the image view shows, with its exposure, offset and tone map, or in its colour scale; of a split view, A", "8 位：图像视图所示画面，含曝光、偏移与色调映射，或按其色标；分屏时为 A";
    Radiance: "Linear radiance (EXR)", "线性辐射亮度（EXR）";
    HelpRadiance: "32-bit floats, W m⁻² sr⁻¹, hidden strategies left out as in the image", "32 位浮点，W m⁻² sr⁻¹；与图像一样不含隐藏的策略";
    AllStrategies: "All strategies (layered EXR)", "全部策略（分层 EXR）";
    HelpAllStrategies: "A layer per strategy, named weighted.s1t2 and so on; together they make the image", "每个策略一层，命名如 weighted.s1t2；相加即得图像";
    PathJson: "This sample (JSON)", "此采样（JSON）";
    HelpPathJson: "Everything about it, as inspect --json prints it", "关于此采样的全部信息，与 inspect --json 输出相同";
    PathSvg: "Diagram of this sample (SVG)", "此采样的示意图（SVG）";
    HelpPathSvg: "Both subpaths, every connection with its weight, and the selected path", "两条子路径、各连接边及其权重，以及所选路径";
    StrategiesCsv: "Table of strategies (CSV)", "策略表（CSV）";
    HelpStrategiesCsv: "A line per strategy of this sample, for a spreadsheet", "此采样的每个策略一行，可用电子表格打开";
    VerticesCsv: "Vertices (CSV)", "顶点表（CSV）";
    HelpVerticesCsv: "The vertices of both subpaths and of every strategy's path", "两条子路径及各策略路径的所有顶点";
    Path: "File", "文件";
    PathHint: "path of the file", "文件路径";
    InFolder: "in {}", "位于 {}";
    SaveNow: "Save this", "保存此项";
    Exists: "This file exists.", "该文件已存在。";
    Replace: "Replace it", "替换";
    Keep: "Keep it", "保留";
    Saving: "saving …", "正在保存……";
    Saved: "Saved {}", "已保存 {}";
    NothingYet: "There is nothing to save yet.", "尚无可保存的内容。";
}
