//! Changes of the scene in a link, a piece for each number: `mat.0.name=wall&mat.0.roughness=0.2&lamp.1.power=3`. The fields
//! are those of [`SceneEdits`] as they are stored, so that a new one travels by itself.

use super::ignored::{Ignored, Why};
use super::words::short;
use crate::scene::SceneEdits;
use crate::scene::edit::{EnvironmentEdit, LampEdit, LightEdit, MaterialEdit};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// Most bytes of a name.
const MOST_NAME: usize = 256;

/// Every change as a piece: its name and its value.
pub fn write(edits: &SceneEdits) -> Vec<(String, String)> {
    let SceneEdits { version: _, materials, lamps, lights, environment } = edits;
    let mut pieces = Vec::new();
    several("mat", materials, &mut pieces);
    several("lamp", lamps, &mut pieces);
    several("light", lights, &mut pieces);
    fields("sky", environment, &mut pieces);
    pieces
}

fn several<T: Edit>(kind: &str, edits: &BTreeMap<u32, T>, pieces: &mut Vec<(String, String)>) {
    edits.iter().for_each(|(index, edit)| fields(&format!("{kind}.{index}"), edit, pieces));
}

fn fields<T: Edit>(whose: &str, edit: &T, pieces: &mut Vec<(String, String)>) {
    let Ok(Value::Object(object)) = serde_json::to_value(edit) else { return };
    for (field, value) in object {
        let alone = |value: Value| serde_json::from_value::<T>(Value::Object([(field.clone(), value)].into_iter().collect())).ok();
        // A number of 32 bits is written with no more digits than it has.
        let narrow = words(&value, &|wide| short(wide as f32));
        let same = numbers(&narrow).is_some_and(|read| alone(read) == alone(value.clone()));
        pieces.push((format!("{whose}.{field}"), if same { narrow } else { words(&value, &short) }));
    }
}

fn words(value: &Value, number: &dyn Fn(f64) -> String) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Array(values) => values.iter().map(|value| words(value, number)).collect::<Vec<_>>().join(","),
        other => other.as_f64().map_or_else(|| other.to_string(), number),
    }
}

/// Is this the name of such a piece?
pub fn is_one(key: &str) -> bool {
    key.split_once('.').is_some_and(|(kind, _)| ["mat", "lamp", "light", "sky"].contains(&kind))
}

/// Reads a piece into the edits; else says why not.
pub fn read(edits: &mut SceneEdits, key: &str, text: &str) -> Result<(), Ignored> {
    let parts: Vec<&str> = key.split('.').collect();
    let outcome = match parts.as_slice() {
        ["sky", field] => set(&mut edits.environment, field, text),
        [kind, index, field] => match (index.parse(), *kind) {
            (Ok(index), "mat") => entry(&mut edits.materials, index, field, text),
            (Ok(index), "lamp") => entry(&mut edits.lamps, index, field, text),
            (Ok(index), "light") => entry(&mut edits.lights, index, field, text),
            _ => Err(Why::Unknown),
        },
        _ => Err(Why::Unknown),
    };
    outcome.map_err(|why| Ignored::new(format!("{key}={text}"), why))
}

fn entry<T: Edit>(map: &mut BTreeMap<u32, T>, index: u32, field: &str, text: &str) -> Result<(), Why> {
    let mut edit = map.get(&index).cloned().unwrap_or_default();
    set(&mut edit, field, text)?;
    map.insert(index, edit);
    Ok(())
}

/// What can be changed field by field.
trait Edit: Clone + Default + PartialEq + Serialize + DeserializeOwned {}
impl Edit for MaterialEdit {}
impl Edit for LampEdit {}
impl Edit for LightEdit {}
impl Edit for EnvironmentEdit {}

/// Sets a field. That it is known shows in what is stored again.
fn set<T: Edit>(edit: &mut T, field: &str, text: &str) -> Result<(), Why> {
    let Ok(Value::Object(mut object)) = serde_json::to_value(&*edit) else { return Err(Why::Unknown) };
    let wanted = if field == "name" { Some(Value::String(text.to_owned())).filter(|_| text.len() <= MOST_NAME) } else { numbers(text) };
    let wanted = wanted.ok_or(Why::Unreadable)?;
    let alone: Map<String, Value> = [(field.to_owned(), wanted.clone())].into_iter().collect();
    let known: T = serde_json::from_value(Value::Object(alone)).map_err(|_| Why::Unreadable)?;
    if known == T::default() && !(field == "name" && text.is_empty()) {
        return Err(Why::Unknown);
    }
    object.insert(field.to_owned(), wanted);
    *edit = serde_json::from_value(Value::Object(object)).map_err(|_| Why::Unreadable)?;
    Ok(())
}

/// A number, or a few.
fn numbers(text: &str) -> Option<Value> {
    let number = |word: &str| word.parse::<f64>().ok().filter(|n| n.is_finite() && word.bytes().all(|b| !b.is_ascii_whitespace()));
    let values: Vec<Value> = text.split(',').map(|word| number(word).map(Value::from)).collect::<Option<_>>()?;
    match <[Value; 1]>::try_from(values) {
        Ok([value]) => Some(value),
        Err(values) => Some(Value::Array(values)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn edits() -> SceneEdits {
        let mut edits = SceneEdits::default();
        let wall =
            MaterialEdit { name: "red wall".into(), color: Some([0.1, 1.0, 0.333_333_34]), roughness: Some(0.2), ..Default::default() };
        edits.materials.insert(3, wall);
        edits.lamps.insert(
            0,
            LampEdit { name: "lamp".into(), power: Some(1e6), offset: Some([0.1, f64::from(0.1f32), 1e-9]), ..Default::default() },
        );
        edits.lights.insert(1, LightEdit { name: "灯".into(), cone: Some([10.0, 20.5]), ..Default::default() });
        edits.environment.rotation = Some(0.1);
        edits
    }

    #[test]
    fn edits_come_back_exactly() {
        let pieces = write(&edits());
        let text: Vec<String> = pieces.iter().map(|(key, value)| format!("{key}={value}")).collect();
        assert!(
            text.contains(&"mat.3.color=0.1,1,0.33333334".to_owned())
                && text.contains(&"lamp.0.offset=0.1,0.10000000149011612,1e-9".to_owned()),
            "{text:?}"
        );
        let mut back = SceneEdits::default();
        for (key, value) in &pieces {
            assert!(is_one(key));
            assert_eq!(read(&mut back, key, value), Ok(()));
        }
        assert_eq!(back, edits());
        assert!(write(&SceneEdits::default()).is_empty());
    }

    #[test]
    fn what_is_no_edit_changes_nothing() {
        let mut edits = edits();
        let before = edits.clone();
        let cases = [
            ("mat.0.shine", "1", Why::Unknown),
            ("mat.0", "1", Why::Unknown),
            ("mat.x.color", "1,1,1", Why::Unknown),
            ("mat.4294967296.color", "1,1,1", Why::Unknown),
            ("sky.0.strength", "1", Why::Unknown),
            ("sky.colour", "1", Why::Unknown),
            ("mat.0.color", "1,1", Why::Unreadable),
            ("mat.0.roughness", "nan", Why::Unreadable),
            ("mat.0.roughness", "", Why::Unreadable),
            ("mat.0.roughness", "rough", Why::Unreadable),
            ("sky.strength", "1,2", Why::Unreadable),
        ];
        for (key, value, why) in cases {
            assert!(is_one(key));
            assert_eq!(read(&mut edits, key, value), Err(Ignored::new(format!("{key}={value}"), why)), "{key}");
        }
        assert_eq!(edits, before);
        assert!(!is_one("size") && !is_one("sound.0"));
    }
}
