//! The texts of the checks, and what the checks themselves say in Chinese (in English they say it themselves).

use super::Lang;
use crate::report::check::{Phrase, Said};

texts! { CheckText;
    Title: "Is this image right?", "这幅图像正确吗？";
    Intro: "Checks of the scene on show, as seen by its camera: its paths, strategies, weights and renderers are held against each other, and against known answers.", "检查当前场景与视角：其路径、策略、权重和渲染器彼此对照，并与已知答案对照。";
    RunAll: "Run all", "全部运行";
    HelpRunAll: "Runs all checks one after the other, about 10 s in all. Rendering stands still meanwhile.", "依次运行全部检查，总共约 10 秒。期间暂停渲染。";
    RunOne: "Run", "运行";
    HelpRunOne: "Runs this check alone. Rendering stands still meanwhile.", "只运行此项检查。期间暂停渲染。";
    Cancel: "Stop", "停止";
    HelpCancel: "Stops the checks. What is done stays.", "停止检查，已完成的结果保留。";
    Thorough: "Thorough", "彻底";
    HelpThorough: "Thirty times the samples: minutes instead of seconds, and smaller errors show. An adapter that runs on the processor counts as a GPU, too.", "样本数为三十倍：需要几分钟，可发现更小的误差；由处理器模拟的显卡也参与比较。";
    Running: "{}: {} %. Rendering stands still meanwhile.", "{}：{} %。期间暂停渲染。";
    NotRun: "not run yet", "尚未运行";
    Underway: "running", "运行中";
    Waiting: "waiting", "等待中";
    Stale: "out of date", "已过期";
    HelpStale: "Scene, camera, lens or settings have changed since: run it again.", "此后场景、相机、镜头或设置已改变：请重新运行。";
    Details: "Click for what it means and what was found.", "点击查看含义与结果。";
    SamplesTime: "{} samples, {} s", "{} 个样本，{} 秒";
    WhatItMeans: "What it means", "含义";
    WhereToLook: "Where to look", "排查方向";
    WhatHelps: "What helps", "有用的做法";
    HowMuch: "How much?", "缺多少？";
    AboutPercent: "about {} %", "约 {} %";
    HelpHowMuch: "Opens the checks' page and estimates what part of the light is missing, and on which kinds of paths: about 3 s, during which rendering stands still.", "打开检查页，估计缺少的光占多少、属于哪些路径：约 3 秒，期间暂停渲染。";
    Show: "Show this sample", "查看此样本";
    HelpShow: "Selects pixel {}, sample {} and strategy {}, the worst case, and shows its path.", "选中最严重的情形：像素 {}、样本 {}、策略 {}，并显示其路径。";
    SummaryPassed: "{} of {} passed", "{} / {} 项通过";
    SummaryFailed: "{} failed", "{} 项未通过";
    NoScene: "There is no scene to check yet.", "尚无可检查的场景。";
    Died: "{}: the check ended unexpectedly; please report the scene and the settings", "{}：检查意外终止，请反馈场景与设置";
    NoThread: "Checks need a thread of their own, and there is none to be had here: {}", "检查需要独立的线程，而此处无法创建：{}";
}

/// What a check says, in a language.
pub fn said(said: &Said, lang: Lang) -> String {
    said.told(&|phrase| phrase_text(phrase, lang))
}

/// One of its sentences.
pub fn phrase_text(phrase: Phrase, lang: Lang) -> &'static str {
    match lang {
        Lang::En => phrase.text(),
        Lang::Zh => chinese(phrase),
    }
}

fn chinese(phrase: Phrase) -> &'static str {
    match phrase {
        Phrase::Passed => "通过",
        Phrase::Failed => "未通过",
        Phrase::TooFew => "样本不足",
        Phrase::DoesNotApply => "不适用",
        Phrase::SomeIsMissing => "缺少光",
        Phrase::NameReplay => "重放",
        Phrase::NamePairwise => "策略两两比较",
        Phrase::NameFurnace => "白炉测试",
        Phrase::NameIntegrators => "BDPT = PT = LT",
        Phrase::NameFinite => "数值有限",
        Phrase::NameGpu => "CPU = GPU",
        Phrase::NameMissing => "缺少的光",
        Phrase::AboutReplay => {
            "把每条采样到的路径仅凭其顶点，由每个可能生成它的策略重建：各策略对其概率密度和光必须一致，各自算出的权重之和必须为 1。"
        }
        Phrase::AboutPairwise => "对每种路径长度，任意两个策略在双方都能生成的路径上必须得到同样多的光。",
        Phrase::AboutFurnace => "在由同一种漫反射材质构成、处处发光的封闭房间里，k 条边的路径恰好带来 L_e ρ^(k−1)。",
        Phrase::AboutIntegrators => "全部策略、路径追踪与光源追踪，在后两者都能生成的路径上，在画面各处必须得到同样多的光。",
        Phrase::AboutFinite => "在任何权重下，贡献都不得为无穷、非数或负数，溅射也不得大到无法计数。",
        Phrase::AboutGpu => "两个渲染器生成相同的样本：几乎所有像素都必须相等。",
        Phrase::AboutMissing => {
            "有些光，所用策略无论渲染多长时间都无法得到，例如针孔相机在镜中看到的点光源。缺少多少？由全部策略共同估计；若都无法生成，则把无面积的光源略微放大。"
        }
        Phrase::MeasuredNothingMissing => "所用策略可生成不超过 {} 条边的每一种路径：不缺少任何光",
        Phrase::MeasuredMissing => "约 {} % 的光（95 % 区间：{} 至 {} %），路径不超过 {} 条边：{}",
        Phrase::MeasuredMissingBlurred => "{}；无面积的光源被放大到场景半径的 {} %，若只放大一半则为 {} %",
        Phrase::MeasuredMissingTooRare => "所用策略都无法生成 {}，但只找到 {} 条这样的路径（共 {} 个样本）：太少，无法说明缺少多少",
        Phrase::OnlyLongOnesMissing => "只缺少超过 {} 条边的路径，此处不作检查",
        Phrase::LightIsMissing => "图像比场景暗：无论样本多少，所用策略都无法生成 {}。",
        Phrase::LookAperture => "可打开光圈：光便会命中镜头（t = 0）。",
        Phrase::LookExtent => "可使用有面积的光源：视线路径便会命中它（s = 0）。",
        Phrase::LookTakeIn => "可重新启用移除的策略。",
        Phrase::Both => "{}{}",
        Phrase::MeasuredReplay => {
            "{} 条路径重建 {} 次：p 最多相差 {}，f 最多相差 {}，Σw 与 1 最多相差 {}（相对值；上限 {}，{} 条路径超出）"
        }
        Phrase::MeasuredPairwise => "判定 {} 对，最大 |z| 为 {}（上限 {}，全部各对的总显著性水平 {}）；{} 对样本不足",
        Phrase::MeasuredFurnace => "辐射亮度 {} ± {}，精确值 {}，路径不超过 {} 条边；各长度中最大 |z| 为 {}（上限 {}，显著性水平 {}）",
        Phrase::MeasuredIntegrators => "PT 得到 BDPT 的光的 {} ± {}，LT 得到 {} ± {}；比较 {} 次，最大 |z| 为 {}（上限 {}，显著性水平 {}）",
        Phrase::MeasuredFinite => "{} 个贡献：{} 个非有限，{} 个为负，{} 个权重在 0…1 之外；渲染 {} 遍、{} 种权重：{} 个被舍弃，{} 个过大",
        Phrase::MeasuredGpu => "{} / {} 个数值在 {} 以内相等，共 {} 遍（至少须占 {}）；{}",
        Phrase::OneStrategy => "没有一种路径长度有两个可比较的策略",
        Phrase::NoLightAtAll => "场景中没有光源",
        Phrase::NoFamily => "路径追踪或光源追踪在此无法生成任何路径",
        Phrase::FurnaceMaterial => "并非所有表面都是同一种发光的纯漫反射材质",
        Phrase::FurnaceLights => "除发光表面外还有其他光源",
        Phrase::FurnaceOpen => "房间不封闭，或并非处处向内发光",
        Phrase::GpuCannot => "GPU 在此不渲染。{}.",
        Phrase::WrongDensity => "两个策略对同一条路径的概率密度意见不一（ln p 相差 {}）：权重有误；凡以该 p 除 f 之处，图像也有误。",
        Phrase::LookDensity => {
            "{} 条边的路径，由 {} 生成，按 {} 重建：{} 相差最大。src/bdpt/path.rs：p_{s+1}/p_s = p_light[s]/p_eye[s]（Veach 10.9）；游走见 src/bdpt/walk.rs。"
        }
        Phrase::WrongWeights => "同一条路径由各策略各自算出的权重之和为 1 ± {}：有光丢失或被重复计算。",
        Phrase::LookWeights => {
            "{} 条边的路径，由 {} 生成。src/bdpt/mis.rs：w_s = (n_s p_s)^β / Σ_i (n_i p_i)^β；其输入见 src/bdpt/path.rs。"
        }
        Phrase::WrongLight => "两个策略在同一条路径上得到不同的光（ln f 相差 {}）：其中一个过亮或过暗。",
        Phrase::LookLight => {
            "{} 条边的路径，由 {} 生成，按 {} 重建。src/bdpt/connect.rs：C*_{s,t} = α^L_s c_{s,t} α^E_t / n，f = C* n p；f 不得取决于由谁生成路径（src/scene/bsdf.rs）。"
        }
        Phrase::WrongForms => "渲染器所用的快速权重与其定义相差 {}。",
        Phrase::LookForms => "{} 条边的路径，由 {} 生成，按 {} 查看。src/bdpt/mis.rs：mis_weight 与 mis_weights_by_definition。",
        Phrase::Impossible => "无法生成某条路径的策略却在其上有权重：这部分光丢失了。",
        Phrase::LookImpossible => "{} 条边的路径，由 {} 生成，{} 的权重。src/bdpt/path.rs：`samplable`；src/bdpt/mis.rs。",
        Phrase::NotRebuilt => "本应能生成某条路径的策略无法重建它（{} / {}）。",
        Phrase::LookNotRebuilt => {
            "{} 条边的路径，由 {} 生成，应按 {} 重建。src/bdpt/replay.rs 说明在何处中止；若连接边只在一个方向被遮挡，见 src/bdpt/visibility.rs。"
        }
        Phrase::WrongPair => "在 {} 条边的路径上，{} 得到的光是 {} ± {} 倍于 {}：两者之一的概率密度或贡献有误。",
        Phrase::LookPair => "最可疑的是 {}，它出现在未通过的各对中的 {} 对（共 {} 对）。{}",
        Phrase::LookEither => "只有这两者不一致：两者都可能有误。{}：{} {}：{}",
        Phrase::LookHitsLight => "src/bdpt/path.rs 的 join_at_light 与 src/scene/light.rs：L_e 与 P_A(x₀)。",
        Phrase::LookNextEvent => "src/bdpt/ends.rs：新选取的光源端点；src/bdpt/connect.rs：c_{1,t}。",
        Phrase::LookLightTracer => "src/bdpt/connect.rs 的 lens_factor 与 src/scene/camera.rs：W_e 与 P_σ⊥。",
        Phrase::LookHitsLens => "src/bdpt/crossing.rs：p = m + l/d，W_e / n。",
        Phrase::LookConnect => "src/bdpt/connect.rs：c_{s,t} = f G V f；src/scene/bsdf.rs。",
        Phrase::WrongFurnace => "{} 条边的路径带来 {} ± {}，而应为 {}：有光丢失或被重复计算。",
        Phrase::WrongFurnaceSum => "所有长度合计带来 {} ± {}，而应为 {}：有光丢失或被重复计算。",
        Phrase::LookFurnace => {
            "src/bdpt/mis.rs 与 path.rs（权重），src/bdpt/context.rs（survival：q 必须双向计入 p），src/scene/bsdf/lambert.rs。再运行“重放”和“策略两两比较”，可知是哪个策略。"
        }
        Phrase::WrongIntegrator => "在相同的路径上，{} 得到的光是全部策略的 {} ± {}，位置：{}。",
        Phrase::LookIntegrator => "{} 的策略中，在那里带来最多光的是 {}。再运行“策略两两比较”，逐一比较。",
        Phrase::WholePicture => "整个画面",
        Phrase::PartOfPicture => "从 {} 到 {} 的像素",
        Phrase::WrongFinite => "{} 个贡献{}：它们被图像舍弃而损失光，或破坏图像。",
        Phrase::NotFinite => "不是有限数",
        Phrase::Negative => "为负",
        Phrase::WeightOutside => "的权重小于 0 或大于 1",
        Phrase::LeftOut => "在渲染时被舍弃",
        Phrase::TooLarge => "过大，无法作为溅射计数",
        Phrase::LookFinite => "{}，权重种类 {}。src/bdpt/connect.rs：短边的 G，为 0 或超出 f32 的概率密度。",
        Phrase::LookSplat => "src/bdpt/render.rs 的 splat_quantum；src/film/mod.rs：每遍 2⁶³ 个量子。",
        Phrase::WrongGpu => "两个渲染器只在 {} 的数值上一致：某个内核的计算不同。",
        Phrase::LookGpu => "像素 {} 处相差最大（{} 的画面）。shaders/*.wgsl 与 src/ 中同名的对应函数；tests/gpu 可找到是哪个函数。",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sentence_has_both_languages_and_the_same_places() {
        for phrase in Phrase::ALL {
            let (en, zh) = (phrase_text(*phrase, Lang::En), phrase_text(*phrase, Lang::Zh));
            assert!(!en.trim().is_empty() && !zh.trim().is_empty(), "{phrase:?}");
            assert_eq!(en.matches("{}").count(), zh.matches("{}").count(), "{phrase:?}");
        }
    }
}
