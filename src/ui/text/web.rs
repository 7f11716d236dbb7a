//! The texts of the program in a page. (What the page says when there is no program is in `web/texts.js`.)

texts! { WebText;
    WebGlAndCpu: "WebGL 2 draws the window, and the CPU renders: {}", "窗口由 WebGL 2 绘制，图像由 CPU 渲染：{}";
    WebGl: "WebGL 2 draws the window: {}", "窗口由 WebGL 2 绘制：{}";
    Cpu: "The CPU renders: {}", "图像由 CPU 渲染：{}";
    WebGpu: "WebGPU renders: {}", "图像由 WebGPU 渲染：{}";
    HelpDrawn: "In a page, WebGPU renders where the browser has it. ?renderer=webgpu, webgl or cpu in the address chooses by hand.", "在网页中，浏览器支持时由 WebGPU 渲染。可在地址中用 ?renderer=webgpu、webgl 或 cpu 手动选择。";
    Asked: "the address asks for it (?renderer={}).", "地址中如此要求（?renderer={}）。";
    NotSecure: "this page came over plain HTTP, where browsers give no WebGPU. Open it over HTTPS, or from localhost.", "此页面经由普通 HTTP 加载，浏览器不提供 WebGPU。请通过 HTTPS 或从 localhost 打开。";
    NoWebGpu: "this browser has no WebGPU.", "此浏览器没有 WebGPU。";
    Refused: "the browser gives no WebGPU adapter on this machine.", "浏览器在此设备上不提供 WebGPU 适配器。";
    Failed: "WebGPU failed ({}).", "WebGPU 失败（{}）。";
    NoSuchRenderer: "?renderer={} in the address is not known and was ignored: it may be webgpu, webgl or cpu.", "地址中的 ?renderer={} 无法识别，已忽略：可用 webgpu、webgl 或 cpu。";
    NotCopied: "The browser let nothing be copied; a link can be taken from the address bar.", "浏览器不允许复制；链接可从地址栏复制。";
    HalfSize: "The memory was used up, so the film has half its width and height: {}×{}.", "内存曾用尽，因此画幅的宽和高减半：{}×{}。";
}
