//! A page's files: those that are dropped on it or chosen by a button are read into its memory, and what is saved is handed to
//! the browser's downloads. Nothing is sent anywhere.

use super::super::files::limits::{MOST_FILES, Trouble, check};
use crate::scene::files::File;
use js_sys::{Array, Promise, Uint8Array};
use std::future::Future;
use std::pin::Pin;
use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast, JsValue};
use wasm_bindgen_futures::JsFuture;
use web_sys::{
    AddEventListenerOptions, Blob, BlobPropertyBag, Document, DragEvent, FileSystemDirectoryEntry, FileSystemEntry, FileSystemFileEntry,
    HtmlAnchorElement, HtmlElement, HtmlInputElement, Url,
};

/// The element that opens the browser's dialog; it cannot be seen.
const INPUT: &str = "file-input";
/// How long the browser may take to begin a download, ms.
const PATIENCE: i32 = 60_000;

/// Files on their way.
pub type Reading = Pin<Box<dyn Future<Output = Result<Vec<File>, Trouble>>>>;

/// Takes whatever files are dropped on the page, wherever: elsewhere than on the window they would replace the page.
pub fn watch_drops(take: impl Fn(Reading) + 'static) {
    let Some(window) = web_sys::window() else { return };
    // Before the window's own listeners, which hear no more of drops outside their canvas.
    let options = AddEventListenerOptions::new();
    options.set_capture(true);
    let listen = |kind: &str, listener: Closure<dyn FnMut(DragEvent)>| {
        let added =
            window.add_event_listener_with_callback_and_add_event_listener_options(kind, listener.as_ref().unchecked_ref(), &options);
        // The page has these as long as it is there.
        listener.forget();
        drop(added);
    };
    let over = |event: DragEvent| {
        if holds_files(&event) {
            event.prevent_default();
        }
    };
    listen("dragover", Closure::new(over));
    let dropped = move |event: DragEvent| {
        if holds_files(&event) {
            event.prevent_default();
            take(Box::pin(read(sources(&event))));
        }
    };
    listen("drop", Closure::new(dropped));
}

/// Lets the person choose files in the browser's dialog, one or `many`; what is chosen goes to `take`.
///
/// # Errors
/// What the browser says if it has no such dialog.
pub fn choose(many: bool, take: impl FnOnce(Reading) + 'static) -> Result<(), String> {
    let open = move || -> Result<(), JsValue> {
        let document = document()?;
        // One that was closed without a choice may still be there.
        if let Some(old) = document.get_element_by_id(INPUT) {
            old.remove();
        }
        let input: HtmlInputElement = hidden(&document, "input")?;
        input.set_type("file");
        input.set_id(INPUT);
        input.set_multiple(many);
        // No filter by ending: some systems know none of these, and would offer nothing.
        let chosen = input.clone();
        let change = Closure::once_into_js(move || {
            let files = chosen.files().map(|list| (0..list.length()).filter_map(|i| list.get(i)).collect::<Vec<_>>());
            chosen.remove();
            take(Box::pin(read(files.unwrap_or_default().into_iter().map(Source::File).collect())));
        });
        input.add_event_listener_with_callback("change", change.unchecked_ref())?;
        input.click();
        Ok(())
    };
    open().map_err(|error| words(&error))
}

/// Hands a file to the browser's downloads.
///
/// # Errors
/// What the browser says if it does not take it.
pub fn download(name: &str, bytes: &[u8]) -> Result<(), String> {
    let offer = || -> Result<(), JsValue> {
        let options = BlobPropertyBag::new();
        options.set_type(media_type(name));
        let blob = Blob::new_with_u8_array_sequence_and_options(&Array::of1(&Uint8Array::from(bytes)), &options)?;
        let url = Url::create_object_url_with_blob(&blob)?;
        let anchor: HtmlAnchorElement = hidden(&document()?, "a")?;
        anchor.set_href(&url);
        anchor.set_download(name);
        anchor.click();
        anchor.remove();
        let done = Closure::once_into_js(move || Url::revoke_object_url(&url));
        let window = web_sys::window().ok_or("no window")?;
        window.set_timeout_with_callback_and_timeout_and_arguments_0(done.unchecked_ref(), PATIENCE)?;
        Ok(())
    };
    offer().map_err(|error| words(&error))
}

fn media_type(name: &str) -> &'static str {
    match name.rsplit_once('.').map(|(_, end)| end) {
        Some("png") => "image/png",
        Some("exr") => "image/x-exr",
        Some("json") => "application/json",
        Some("svg") => "image/svg+xml",
        Some("csv") => "text/csv",
        _ => "application/octet-stream",
    }
}

fn document() -> Result<Document, JsValue> {
    Ok(web_sys::window().and_then(|window| window.document()).ok_or("no document")?)
}

/// A new element of the page, which nobody sees.
fn hidden<T: JsCast>(document: &Document, kind: &str) -> Result<T, JsValue> {
    let element: HtmlElement = document.create_element(kind)?.unchecked_into();
    element.style().set_property("display", "none")?;
    document.body().ok_or("no body")?.append_child(&element)?;
    Ok(element.unchecked_into())
}

fn words(error: &JsValue) -> String {
    match error.dyn_ref::<js_sys::Error>() {
        Some(error) => String::from(error.message()),
        None => error.as_string().unwrap_or_else(|| format!("{error:?}")),
    }
}

/// What can be read.
enum Source {
    File(web_sys::File),
    Entry(FileSystemEntry),
}

/// Is it files that are dragged, not words or links?
fn holds_files(event: &DragEvent) -> bool {
    event.data_transfer().is_some_and(|data| data.types().includes(&"Files".into(), 0))
}

/// What was dropped; what is a folder is known only now, while the event lasts.
fn sources(event: &DragEvent) -> Vec<Source> {
    let Some(data) = event.data_transfer() else { return Vec::new() };
    let items = data.items();
    let folder = |i: u32| {
        let entry = items.get(i)?.webkit_get_as_entry().ok().flatten()?;
        entry.is_directory().then_some(Source::Entry(entry))
    };
    let file = |i: u32| items.get(i)?.get_as_file().ok().flatten().map(Source::File);
    (0..items.length()).filter_map(|i| folder(i).or_else(|| file(i))).collect()
}

/// Reads everything, if it is not too much.
async fn read(sources: Vec<Source>) -> Result<Vec<File>, Trouble> {
    let mut found = Vec::new();
    for source in sources {
        match source {
            Source::File(file) => found.push((file.name(), file)),
            Source::Entry(entry) => walk(entry, &mut found).await?,
        }
    }
    check(found.iter().map(|(name, file)| (name.as_str(), file.size() as u64)))?;
    let mut files = Vec::new();
    for (name, file) in found {
        let bytes = read_one(&name, &file).await?;
        files.push(File::new(name, bytes));
    }
    Ok(files)
}

async fn read_one(name: &str, file: &web_sys::File) -> Result<Vec<u8>, Trouble> {
    let buffer = JsFuture::from(file.array_buffer()).await.map_err(|error| Trouble::Unreadable(name.to_owned(), words(&error)))?;
    let array = Uint8Array::new(&buffer);
    let mut bytes = Vec::new();
    let length = array.length() as usize;
    bytes.try_reserve_exact(length).map_err(|_| Trouble::NoMemory(name.to_owned(), length as u64))?;
    bytes.resize(length, 0);
    array.copy_to(&mut bytes);
    Ok(bytes)
}

/// Adds all files below a folder to `found`, with their paths; those whose names begin with a dot are somebody else's.
async fn walk(folder: FileSystemEntry, found: &mut Vec<(String, web_sys::File)>) -> Result<(), Trouble> {
    let mut left = vec![folder];
    while let Some(entry) = left.pop() {
        let path = entry.full_path().trim_start_matches('/').to_owned();
        let trouble = |error: JsValue| Trouble::Unreadable(path.clone(), words(&error));
        if entry.name().starts_with('.') {
            continue;
        }
        if found.len() + left.len() > MOST_FILES {
            return Err(Trouble::TooMany);
        }
        if entry.is_directory() {
            let reader = entry.unchecked_into::<FileSystemDirectoryEntry>().create_reader();
            loop {
                let ask = Promise::new(&mut |yes, no| drop(reader.read_entries_with_callback_and_callback(&yes, &no)));
                let some = Array::from(&JsFuture::from(ask).await.map_err(trouble)?);
                if some.length() == 0 {
                    break;
                }
                left.extend(some.iter().map(JsCast::unchecked_into::<FileSystemEntry>));
            }
        } else {
            let entry: FileSystemFileEntry = entry.unchecked_into();
            let ask = Promise::new(&mut |yes, no| entry.file_with_callback_and_callback(&yes, &no));
            let file = JsFuture::from(ask).await.map_err(trouble)?;
            found.push((path.clone(), file.unchecked_into()));
        }
    }
    Ok(())
}
