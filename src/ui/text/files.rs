//! The texts of files that are given to the page, and of those it hands out.

texts! { FilesText;
    HelpScene: "Choose a built-in scene, or open files of your own: a .glb, a .gltf with its .bin and pictures, or an environment (.hdr, .exr). They can be dropped on the page, too.", "选择内置场景，或打开自己的文件：.glb，.gltf 及其 .bin 与图片，或环境图（.hdr、.exr）。也可把它们拖到页面上。";
    Choose: "Open files…", "打开文件…";
    HelpChoose: "Choose a .glb, or a .gltf together with its .bin and pictures. The files are read in this page: nothing leaves this computer.", "选择 .glb，或 .gltf 连同其 .bin 与图片。文件只在此页面中读取：不会离开这台电脑。";
    OrDrop: "… or drop them here, also as a folder. Nothing leaves this computer.", "……或拖到此处，也可拖入文件夹。文件不会离开这台电脑。";
    ChooseEnvironment: "Environment picture…", "环境图…";
    HelpChooseEnvironment: "Lights the scene with a .hdr or .exr picture. Nothing leaves this computer.", "用 .hdr 或 .exr 图照亮场景。文件不会离开这台电脑。";
    EnvironmentColour: "Or its radiance R,G,B:", "或辐射亮度 R,G,B：";
    EnvironmentHint: "such as 0.2,0.3,0.5", "例如 0.2,0.3,0.5";
    NoPaths: "{}: give a radiance R,G,B; a picture is opened with the button", "{}：请输入辐射亮度 R,G,B；图片请用按钮打开";
    ChooseReference: "Choose a .exr or .hdr file…", "选择 .exr 或 .hdr 文件…";
    Reading: "reading files …", "正在读取文件……";
    // What is wrong with what was given.
    TooLarge: "{} has {} MiB, at most {} MiB of a file can be read in the browser: make it smaller, or open it with the program on a desktop.", "{} 有 {} MiB，浏览器中单个文件最多 {} MiB：请缩小文件，或用桌面版打开。";
    TooMuch: "These files have {} MiB together, at most {} MiB can be read in the browser: give only those the scene needs, make them smaller, or open the scene with the program on a desktop.", "这些文件共 {} MiB，浏览器中最多 {} MiB：请只给出场景所需的文件，缩小它们，或用桌面版打开场景。";
    TooMany: "These are more than {} files: give only those the scene needs.", "文件超过 {} 个：请只给出场景所需的文件。";
    NoMemory: "{}: the browser has no {} MiB left for it: close other pages, or make it smaller.", "{}：浏览器剩余内存不足 {} MiB：请关闭其他页面，或缩小文件。";
    Unreadable: "{} cannot be read ({}): if it has moved or changed, or is a folder, give the files once more.", "{} 无法读取（{}）：若文件已移动或更改，或是文件夹，请重新给出文件。";
    NoneGiven: "There is no file in what was given.", "其中没有文件。";
    SeveralScenes: "Several scenes were given, {}: give one of them, with its own files.", "给出了多个场景 {}：请只给其中一个及其文件。";
    SeveralEnvironments: "Several environments were given, {}: give one of them.", "给出了多个环境图 {}：请只给其中一个。";
    NoScene: "{}: there is no scene (.glb, .gltf) and no environment (.hdr, .exr) among these; give a .gltf together with the files it names.", "{}：其中没有场景（.glb、.gltf）或环境图（.hdr、.exr）；请把 .gltf 与其引用的文件一起给出。";
    AndMore: "{} and {} more", "{} 等，另有 {} 个";
    // Saving.
    FileName: "File name", "文件名";
    Downloaded: "{} was handed to the browser's downloads.", "{} 已交给浏览器下载。";
    NoDownload: "{} could not be handed to the browser's downloads ({}): allow this page to download files and save it once more.", "{} 无法交给浏览器下载（{}）：请允许此页面下载文件，然后重新保存。";
    LayersTooLarge: "The strategies' images take {} MiB, at most {} MiB can be saved in the browser: choose a smaller film or fewer edges, or use the program on a desktop.", "各策略的图像需 {} MiB，浏览器中最多可保存 {} MiB：请减小画幅或边数，或使用桌面版。";
}
