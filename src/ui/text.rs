//! Every text of the window in English and Simplified Chinese, in tables (`text/`), one for each part of it, switched while the program runs.
//! A `{}` stands for a value that is filled in, in order.

/// A table of texts: `texts! { Name; Key: "English", "简体中文"; … }`.
macro_rules! texts {
    ($name:ident; $($key:ident: $en:literal, $zh:literal;)*) => {
        /// A text of the window.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[allow(missing_docs)]
        pub enum $name { $($key,)* }

        impl $name {
            /// All of them.
            pub const ALL: &[Self] = &[$(Self::$key,)*];

            /// The text in a language.
            pub const fn in_language(self, lang: $crate::ui::text::Lang) -> &'static str {
                match (self, lang) { $((Self::$key, $crate::ui::text::Lang::En) => $en, (Self::$key, $crate::ui::text::Lang::Zh) => $zh,)* }
            }
        }

        impl $crate::ui::text::Words for $name {
            fn in_language(self, lang: $crate::ui::text::Lang) -> &'static str {
                Self::in_language(self, lang)
            }
        }
    };
}

mod check;
mod edit;
mod error;
mod export;
mod files;
mod inspect;
mod link;
mod looks;
mod phone;
mod space;
mod study;
mod suggest;
mod summary;
mod table;
mod tour;
mod view;
mod web;

pub use check::{CheckText, phrase_text, said};
pub use edit::EditText;
pub use error::ErrorText;
pub use export::ExportText;
pub use files::FilesText;
pub use inspect::InspectText;
pub use link::LinkText;
pub use looks::LooksText;
pub use phone::PhoneText;
pub use space::SpaceText;
pub use study::StudyText;
pub use suggest::SuggestText;
pub use summary::SummaryText;
pub use table::Text;
pub use tour::TourText;
pub use view::ViewText;
pub use web::WebText;

use crate::bdpt::record::SplitReason;
use crate::bdpt::{Absence, End, Reason};
use crate::gpu::GpuError;
use serde::{Deserialize, Serialize};

/// The window's languages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Lang {
    /// English.
    #[default]
    En,
    /// 简体中文.
    Zh,
}

/// A text that there is in both languages.
pub trait Words: Copy {
    /// The text in a language.
    fn in_language(self, lang: Lang) -> &'static str;
}

/// Puts values in the places of a text, in order.
pub fn fill(text: &str, values: &[&str]) -> String {
    let mut parts = text.split("{}");
    let mut filled = parts.next().unwrap_or_default().to_owned();
    for (index, part) in parts.enumerate() {
        filled.push_str(values.get(index).copied().unwrap_or_default());
        filled.push_str(part);
    }
    filled
}

/// Why a strategy contributes nothing, in a sentence.
pub fn reason_text(reason: Reason, lang: Lang) -> &'static str {
    match lang {
        Lang::En => reason.text(),
        Lang::Zh => match reason {
            Reason::LightSubpathTooShort => "光源子路径在得到 s 个顶点之前就结束了",
            Reason::EyeSubpathTooShort => "视线子路径在得到 t 个顶点之前就结束了",
            Reason::NotMet => "视线子路径只与每轮的第一条光源子路径连接",
            Reason::LightVertexIsDirac => "光源子路径的末端是镜面或玻璃：它只向个别方向散射，不会沿连接边",
            Reason::EyeVertexIsDirac => "视线子路径的末端是镜面或玻璃：它只向个别方向散射，不会沿连接边",
            Reason::NotOnALight => "视线子路径的末端不在光源上",
            Reason::BackOfTheLight => "光源在此处不向这个方向发光",
            Reason::EyeVertexAtInfinity => "视线子路径离开了场景：其末端是环境",
            Reason::LightMissesTheLens => "光源子路径的这条边没有从正面穿过镜头",
            Reason::LightNotShown => "点光源、聚光灯和平行光没有面积，不直接显示",
            Reason::BehindTheCamera => "光源子路径的末端在相机后方",
            Reason::OutsideTheFilm => "光源子路径的末端在画面之外",
            Reason::LightVertexScattersNothing => "光源子路径的末端不沿连接边散射：边在表面的另一侧离开",
            Reason::EyeVertexScattersNothing => "视线子路径的末端不沿连接边散射：边在表面的另一侧到达",
            Reason::DegenerateEdge => "连接边的两端重合，或连接边位于表面所在的平面内",
            Reason::Blocked => "连接边的两端之间有遮挡",
            Reason::NoLight => "场景中没有光源",
            Reason::Removed => "该策略已被移除，不参与计算",
        },
    }
}

/// The same in a few words, for a table.
pub fn reason_short(reason: Reason, lang: Lang) -> &'static str {
    let text = match reason {
        Reason::LightSubpathTooShort => Text::ShortLightTooShort,
        Reason::EyeSubpathTooShort => Text::ShortEyeTooShort,
        Reason::NotMet => Text::ShortNotMet,
        Reason::LightVertexIsDirac => Text::ShortLightDirac,
        Reason::EyeVertexIsDirac => Text::ShortEyeDirac,
        Reason::NotOnALight => Text::ShortNotOnALight,
        Reason::BackOfTheLight => Text::ShortBackOfLight,
        Reason::EyeVertexAtInfinity => Text::ShortEyeAtInfinity,
        Reason::LightMissesTheLens => Text::ShortMissesLens,
        Reason::LightNotShown => Text::ShortLightNotShown,
        Reason::BehindTheCamera => Text::ShortBehindCamera,
        Reason::OutsideTheFilm => Text::ShortOutsideFilm,
        Reason::LightVertexScattersNothing => Text::ShortLightBlack,
        Reason::EyeVertexScattersNothing => Text::ShortEyeBlack,
        Reason::DegenerateEdge => Text::ShortDegenerate,
        Reason::Blocked => Text::ShortBlocked,
        Reason::NoLight => Text::ShortNoLight,
        Reason::Removed => Text::CellRemoved,
    };
    text.in_language(lang)
}

/// Why a strategy does not exist in a scene, in a sentence without its full stop.
pub fn absence_text(absence: Absence, lang: Lang) -> &'static str {
    match lang {
        Lang::En => absence.text(),
        Lang::Zh => match absence {
            Absence::NoLight => "场景中没有光源",
            Absence::PinholeCannotBeHit => "针孔没有面积，光源子路径无法命中：请给镜头一个半径",
            Absence::LightsCannotBeHit => "所有光源都是点光源、聚光灯或平行光：视线子路径无法命中",
            Absence::LightsNotShown => "所有光源都是点光源、聚光灯或平行光，不直接显示",
            Absence::NothingScatters => "没有表面散射光",
            Absence::NothingToConnect => "所有表面都是镜面或玻璃：它们只向个别方向散射，无法连接",
        },
    }
}

/// The same in a few words, for a narrow place.
pub fn absence_short(absence: Absence, lang: Lang) -> &'static str {
    let text = match absence {
        Absence::NoLight => Text::AbsentNoLight,
        Absence::PinholeCannotBeHit => Text::AbsentPinhole,
        Absence::LightsCannotBeHit => Text::AbsentLights,
        Absence::LightsNotShown => Text::AbsentNotShown,
        Absence::NothingScatters => Text::AbsentScatters,
        Absence::NothingToConnect => Text::AbsentConnects,
    };
    text.in_language(lang)
}

/// What kind of light (`VertexRecord::light`).
pub fn light_kind(kind: &str, lang: Lang) -> &'static str {
    let text = match kind {
        "area" => Text::LightArea,
        "point" => Text::LightPoint,
        "spot" => Text::LightSpot,
        "directional" => Text::LightDirectional,
        _ => Text::LightEnvironment,
    };
    text.in_language(lang)
}

/// What a material does with light (`VertexRecord::model`).
pub fn material_kind(kind: &'static str, lang: Lang) -> &'static str {
    match (lang, kind) {
        (Lang::En, _) => kind,
        (_, "lambert") => "漫反射",
        (_, "mirror") => "镜面",
        (_, "dielectric") => "玻璃",
        (_, "thin dielectric") => "薄玻璃",
        (_, "rough metal") => "粗糙金属",
        (_, "coat") => "涂层",
        (_, "unlit") => "无光照材质",
        _ => kind,
    }
}

/// Why a split cannot make the path.
pub fn split_reason(reason: SplitReason, lang: Lang) -> &'static str {
    let text = match reason {
        SplitReason::PinholeCannotBeHit => Text::SplitPinhole,
        SplitReason::LightCannotBeHit => Text::SplitLight,
        SplitReason::DiracEnd => Text::SplitDirac,
        SplitReason::ZeroDensity => Text::SplitZero,
        SplitReason::Removed => Text::SplitRemoved,
    };
    text.in_language(lang)
}

/// Why the GPU does not render, in Chinese (the error itself says it in English). What a driver says stays as it is.
pub fn gpu_error(error: &GpuError) -> String {
    let mib = |bytes: &u64| (bytes.div_ceil(1 << 20)).to_string();
    match error {
        GpuError::NoAdapter(why) => format!("没有可用于计算着色器的图形适配器（{why}）。"),
        GpuError::CannotCompute { adapter, lacks } => format!("图形适配器 {adapter} 缺少 {lacks}。"),
        GpuError::SoftwareOnly(adapter) => format!("唯一的图形适配器 {adapter} 在处理器上运行，CPU 渲染器更快。"),
        GpuError::NoDevice(why) => format!("图形适配器未提供设备：{why}。"),
        GpuError::Shader(message) => format!("着色器无法编译：{message}。"),
        GpuError::NoThread => "没有用于编译内核的线程。".to_owned(),
        GpuError::TooLarge { what, need, have } => format!("{what} 需要 {} MiB 显存，上限为 {} MiB。", mib(need), mib(have)),
        GpuError::OutOfMemory(what) => format!("显存不足：{what}。"),
        GpuError::Lost(why) => format!("图形设备丢失（{why}）。"),
        GpuError::WrongResult(what) => format!("图形适配器计算有误：{what}。"),
        GpuError::Refused(message) => format!("图形接口拒绝了调用：{message}。"),
    }
}

/// Why a subpath has no further vertex.
pub fn end_text(end: End, lang: Lang) -> &'static str {
    let text = match end {
        End::MaxEdges => Text::EndMaxEdges,
        End::Escaped => Text::EndEscaped,
        End::Roulette => Text::EndRoulette,
        End::Absorbed => Text::EndAbsorbed,
        End::NoLight => Text::ShortNoLight,
        End::NotNeeded => Text::EndNotNeeded,
    };
    text.in_language(lang)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check<T: Words + std::fmt::Debug>(table: &[T]) {
        for text in table {
            let (en, zh) = (text.in_language(Lang::En), text.in_language(Lang::Zh));
            assert!(!en.trim().is_empty() && !zh.trim().is_empty(), "{text:?}");
            assert_eq!(en.matches("{}").count(), zh.matches("{}").count(), "{text:?}");
            assert!(!en.chars().any(|c| ('\u{4e00}'..='\u{9fff}').contains(&c)), "{text:?} is Chinese in English");
        }
    }

    #[test]
    fn every_text_has_both_languages_and_the_same_places() {
        check(Text::ALL);
        check(CheckText::ALL);
        check(EditText::ALL);
        check(ErrorText::ALL);
        check(ExportText::ALL);
        check(FilesText::ALL);
        check(LinkText::ALL);
        check(LooksText::ALL);
        check(SuggestText::ALL);
        check(PhoneText::ALL);
        check(InspectText::ALL);
        check(SpaceText::ALL);
        check(StudyText::ALL);
        check(SummaryText::ALL);
        check(TourText::ALL);
        check(ViewText::ALL);
        check(WebText::ALL);
    }

    /// What the page says by itself (`web/texts.js`), as pairs of a key and its texts.
    fn page(lang: &str) -> Vec<(String, Vec<String>)> {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("web/texts.js");
        let source = std::fs::read_to_string(path).unwrap();
        let (_, from) = source.split_once(&format!("\n  {lang}: {{\n")).unwrap();
        let (table, _) = from.split_once("\n  },").unwrap();
        let mut found: Vec<(String, Vec<String>)> = Vec::new();
        for line in table.lines() {
            let rest = match line.strip_prefix("    ").filter(|line| line.starts_with(|c: char| c.is_ascii_lowercase())) {
                Some(entry) => {
                    let (key, rest) = entry.split_once(": ").unwrap();
                    found.push((key.to_owned(), Vec::new()));
                    rest
                }
                None => line,
            };
            // Between straight quotes; the texts themselves have curved ones.
            found.last_mut().unwrap().1.extend(rest.split('"').skip(1).step_by(2).map(str::to_owned));
        }
        found
    }

    #[test]
    fn the_page_has_the_same_texts_in_both_languages() {
        let (en, zh) = (page("en"), page("zh"));
        assert!(en.len() > 10 && en.iter().any(|(key, texts)| key == "memory" && texts.len() == 3), "{en:?}");
        let shape = |texts: &[(String, Vec<String>)]| {
            let places = |text: &String| text.matches("{}").count();
            texts.iter().map(|(key, texts)| (key.clone(), texts.iter().map(places).collect())).collect::<Vec<(String, Vec<usize>)>>()
        };
        assert_eq!(shape(&en), shape(&zh));
        let chinese = |text: &str| text.chars().any(|c| ('\u{4e00}'..='\u{9fff}').contains(&c));
        assert!(zh.iter().flat_map(|(_, texts)| texts).all(|text| chinese(text)));
        assert!(!en.iter().flat_map(|(_, texts)| texts).any(|text| text.trim().is_empty() || chinese(text)));
    }

    #[test]
    fn values_fill_their_places() {
        assert_eq!(fill("{} of {}", &["1", "2"]), "1 of 2");
        assert_eq!(fill("none", &["1"]), "none");
        assert_eq!(fill("{}{}", &["1"]), "1");
    }
}
