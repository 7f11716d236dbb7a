//! The texts of small windows, and of fingers.

texts! { PhoneText;
    Menu: "Menu", "菜单";
    HelpMenu: "Integrator, rendering, saving, and how the window looks", "积分器、渲染设置、保存和窗口外观";
    Image: "Image", "图像";
    Keys: "Keys and gestures", "按键与手势";
    Close: "Close", "关闭";
    Fingers: "Fingers: a tap on the image picks a pixel, a tap on a mark selects it, a long tap picks the pixel below a mark. One finger moves the image or turns the 3-D view; two move and zoom.", "手指：轻点图像选择像素，轻点标记选中该标记，长按则选择标记下的像素。单指移动图像或环绕三维视图，双指平移和缩放。";
    FingersSpace: "One finger orbits, two pan and zoom; a tap selects a vertex or an edge, a long tap the pixel that shows a surface", "单指环绕，双指平移和缩放；轻点选择顶点或边，长按表面选择显示该处的像素";
    TourPixel: "Tap anywhere in the image: the paths of that pixel appear.", "轻点图像任意处：显示生成该像素的路径。";
    TourSample: "Inspector: tap Next. Every sample of a pixel is another pair of subpaths.", "检查器：轻点“下一个”。像素的每个采样都是另一对子路径。";
    TourStrategy: "Tap a strategy in the inspector or in the pyramid: the path it makes is drawn in violet.", "在检查器或金字塔中轻点一个策略：它生成的路径以紫色画出。";
    TourHide: "Pyramid: tap the eye of a strategy. It is left out of the sum, and the image loses just that light.", "金字塔：轻点一个策略的眼睛。该策略不计入总和，图像只失去这部分光。";
    TourSplits: "Inspector: tap Splits. The very same path, made by every other strategy, with their weights.", "检查器：轻点“拆分”。同一条路径由其他各策略生成时的密度与权重。";
}
