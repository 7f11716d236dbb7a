//! The texts of the scene's page and of whatever changes the scene.

texts! { EditText;
    // The page.
    OfTheVertex: "Of the selected vertex", "所选顶点";
    HelpOfTheVertex: "What the selected vertex of the selected path lies on. Click a pixel, step through the vertices with Space, and change what is there.", "所选路径的所选顶点所在的物体。点击像素，用空格键逐个选择顶点，然后修改那里的参数。";
    NoVertex: "No vertex is selected: this strategy made no path for this sample.", "未选中顶点：此采样策略在这个样本中没有生成路径。";
    OnTheLens: "The vertex lies on the lens: see the camera below.", "该顶点位于镜头上：见下方的相机。";
    Lights: "Lights", "光源";
    NoLights: "There are none.", "没有光源。";
    Materials: "Materials", "材质";
    CameraAndLens: "Camera and lens", "相机与镜头";
    More: "… and {} more: click one in the picture.", "……还有 {} 个：请在画面中点击选择。";
    // Steps.
    Undo: "Undo", "撤销";
    Redo: "Redo", "重做";
    ResetAll: "All as in the file", "全部恢复为文件";
    HelpResetAll: "Takes back every change of the scene, the camera's place and the lens (this can be undone).", "恢复场景、相机位置和镜头的所有更改（可以撤销）。";
    Reset: "Reset", "还原";
    ResetOne: "Reset {}", "还原 {}";
    HelpReset: "As in the file again.", "恢复为文件中的值。";
    // Lights.
    Power: "Power", "功率";
    HelpPower: "What multiplies the lamp's radiance, and with it its power.", "灯的辐射亮度（以及功率）的倍数。";
    Color: "Colour", "颜色";
    HelpLampColor: "Hue of what the lamp emits, linear RGB; how strong its brightest channel is stays as it was.", "灯所发光的色相，线性 RGB；最亮通道的强度不变。";
    HelpColor: "Hue of the light, linear RGB.", "光的色相，线性 RGB。";
    Position: "Position", "位置";
    HelpLampPosition: "Where the middle of the lamp is, m, in the file's coordinates. The lamp moves as a whole.", "灯的中心位置，单位 m，文件坐标。灯作为整体移动。";
    HelpPosition: "Where the light is, m, in the file's coordinates.", "光源的位置，单位 m，文件坐标。";
    Size: "Size", "大小";
    HelpSize: "What multiplies the lamp's lengths about its middle. Its radiance stays: a larger lamp has more power.", "以灯的中心为准的长度倍数。辐射亮度不变：灯越大功率越大。";
    LampNumbers: "L {} W m⁻² sr⁻¹ · {} m² · Φ {} W", "L {} W m⁻² sr⁻¹ · {} m² · Φ {} W";
    HelpLampNumbers: "Radiance, area and power of the lamp, textures not counted.", "灯的辐射亮度、面积和功率（不计纹理）。";
    Intensity: "Intensity", "强度";
    Irradiance: "Irradiance", "辐照度";
    HelpStrength: "How strong the light's brightest channel is.", "光源最亮通道的强度。";
    Direction: "Direction", "方向";
    HelpDirection: "Where the light shines; only the direction of this vector counts.", "光照射的方向；只有向量的方向起作用。";
    ConeInner: "Full up to", "全亮角";
    ConeOuter: "Dark from", "全暗角";
    HelpCone: "The angles from the axis up to which the spot has its full intensity, and from which on it is dark.", "聚光灯保持全部强度的角度，以及开始完全变暗的角度（从轴线量起）。";
    Strength: "Strength", "强度";
    HelpSkyStrength: "What multiplies the environment's radiance.", "环境辐射亮度的倍数。";
    Rotation: "Turn", "旋转";
    HelpRotation: "How far the environment is turned about the vertical, counter-clockwise seen from above.", "环境绕竖直轴旋转的角度（俯视逆时针）。";
    // Materials.
    BaseColor: "Base colour", "基色";
    HelpBaseColor: "Diffuse: the albedo. Metal: the reflectance seen head-on. Glass: the tint of what passes. Linear RGB.", "漫反射：反照率；金属：正入射反射率；玻璃：透射光的颜色。线性 RGB。";
    Roughness: "Roughness", "粗糙度";
    HelpRoughness: "α of GGX is its square; a metal below 0.03 is a mirror.", "GGX 的 α 为其平方；金属低于 0.03 时为镜面。";
    Metallic: "Metallic", "金属度";
    HelpMetallic: "Share of the metal: 0 is none, 1 a metal.", "金属所占比例：0 为非金属，1 为金属。";
    Ior: "IOR", "折射率";
    HelpIor: "Index of refraction, inside over outside: 1.33 water, 1.5 glass, 2.4 diamond.", "折射率（内部与外部之比）：水 1.33，玻璃 1.5，钻石 2.4。";
    Emission: "Emission", "发光";
    HelpEmission: "Radiance that the surface emits by itself, its brightest channel, W m⁻² sr⁻¹.", "表面自身发出的辐射亮度（最亮通道），W m⁻² sr⁻¹。";
    EmissionColor: "Its colour", "发光颜色";
    HelpEmissionColor: "Hue of what the surface emits, linear RGB.", "表面所发光的色相，线性 RGB。";
    TexturesMultiply: "Textures multiply these numbers.", "纹理会乘以这些数值。";
    // Camera.
    MoveCamera: "Move camera", "移动相机";
    HelpMoveCamera: "Drag the image to orbit the camera about what is under the pointer; Shift or the middle button pans, the wheel goes nearer, the right button looks around, with W A S D Q E flying. Without this switch: the same with Alt held.", "拖动图像使相机绕指针下的物体旋转；Shift 或中键平移，滚轮靠近，右键环视并用 W A S D Q E 飞行。不按此开关时：按住 Alt 效果相同。";
    CameraOfFile: "Camera as in the file", "恢复文件中的相机";
    HelpCameraOfFile: "Puts the camera back to where the file has it.", "把相机放回文件中的位置。";
    HelpCameraPosition: "Centre of the lens, m, in the file's coordinates.", "镜头中心，单位 m，文件坐标。";
    Aim: "Aim", "朝向";
    HelpAim: "Where the camera looks: to the right of −Z seen from above, and up, degrees.", "相机朝向：俯视时相对 −Z 向右的角度，以及向上的角度。";
    Yfov: "Angle of view", "视角";
    HelpYfov: "Vertical angle of view, degrees.", "垂直视角，单位度。";
    Bookmarks: "Views", "视图书签";
    HelpBookmarks: "Keeps where the camera stands, with its lens, for the next time this scene is open.", "保存相机位置和镜头，下次打开此场景时可用。";
    BookmarkName: "Name of the view", "视图名称";
    BookmarkKeep: "Keep this view", "保存此视图";
    BookmarkDefault: "View {}", "视图 {}";
    HelpBookmarkGo: "Go to this view.", "转到此视图。";
    BookmarkRename: "Rename", "重命名";
    BookmarkRenameOne: "Rename view {}", "重命名视图 {}";
    BookmarkDelete: "Delete", "删除";
    BookmarkDeleteOne: "Delete view {}", "删除视图 {}";
    // Files.
    OpenFile: "Open file…", "打开文件…";
    HelpOpenFile: "Choose a .glb or .gltf file in the system's dialog.", "在系统对话框中选择 .glb 或 .gltf 文件。";
    OpenTitle: "Open a scene", "打开场景";
    NoDialog: "This system shows no file dialog: type the path into the scene menu, or drop the file on the window.", "此系统无法显示文件对话框：请在场景菜单中输入路径，或把文件拖到窗口上。";
    Recent: "Opened last:", "最近打开：";
    ReloadFailed: "The file has changed, but its new version cannot be shown; the old picture stays. {}", "文件已更改，但新版本无法显示；保留旧画面。{}";
    EditsLost: "The new version of the scene has no place for the changes of: {}.", "新版本的场景中没有以下更改的对应项：{}。";
}
