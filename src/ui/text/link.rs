//! The texts of links: what copies them, and what is said of one that cannot be followed as it stands.

texts! { LinkText;
    CopyLink: "Copy link", "复制链接";
    HelpCopy: "Whoever opens the link sees the same scene, with its changes, the same camera, sample and path, and the same panels.", "打开链接的人会看到同样的场景及其更改、同样的相机、采样和路径，以及同样的面板。";
    HelpCopyHash: "There is no address here, so only its part from # on is copied: put it behind the address of the explorer's page, or start bdpt-explorer --link '#…'.", "此处没有网址，因此只复制 # 之后的部分：把它接在网页版地址之后，或运行 bdpt-explorer --link '#…'。";
    Copied: "Link copied ({} letters).", "链接已复制（{} 个字符）。";
    NoClipboard: "This page came over plain HTTP, where browsers let nothing be copied: take the link from the address bar.", "此页面经由普通 HTTP 加载，浏览器不允许复制：请从地址栏复制链接。";
    WithoutEdits: "The changes of the scene are not in it: they would make it too long.", "其中不含对场景的更改：否则链接过长。";
    WithoutFile: "{} does not travel with it, only its name: whoever opens the link needs the file.", "链接只包含文件名 {}，不含文件本身：打开链接的人需要有该文件。";
    WithoutKept: "Kept pictures do not travel with it, nor do references.", "保留的画面和参考图不会随链接传递。";
    // What was not followed.
    Ignored: "Not everything in the link could be followed: {}.", "链接中有些内容无法采用：{}。";
    Unknown: "“{}” is not known here", "不认识“{}”";
    Unreadable: "“{}” cannot be read", "“{}”无法读取";
    Twice: "“{}” stands there twice, the first one counts", "“{}”重复出现，以第一个为准";
    Instead: "instead of “{}” it is {}", "“{}”改为 {}";
    NoPlace: "the scene has no place for “{}”", "场景中没有与“{}”对应的内容";
    NoScene: "there is no scene for “{}”, so the first one is shown", "没有“{}”对应的场景，因此显示第一个场景";
    Refused: "“{}” was left out ({})", "“{}”未采用（{}）";
    Newer: "“{}”: a newer version of the explorer made it", "“{}”：由更新版本的程序生成";
    OtherPaths: "“{}”: in the version that made it, the same sample takes another path", "“{}”：在生成该链接的版本中，同一采样的路径不同";
    OtherScene: "“{}” belongs to that scene", "“{}”属于那个场景";
    AndMore: "and {} more", "另有 {} 处";
    TooLong: "The link has {} letters, and at most {} are read: it was not followed.", "链接有 {} 个字符，最多读取 {} 个：未采用该链接。";
    // Files it needs.
    NeedsScene: "The link shows {}, a file that does not travel with it: drop it on the window, and what the link says of it is shown.", "链接所示场景为文件 {}，它不随链接传递：将该文件拖放到窗口中，即可显示链接的内容。";
    NeedsSky: "In the link, {} lights the scene, a file that does not travel with it: drop it on the window.", "链接中的场景由文件 {} 照亮，它不随链接传递：请将该文件拖放到窗口中。";
}
