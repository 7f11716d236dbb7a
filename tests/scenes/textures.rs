//! Images and textures: formats, where they lie, samplers, transforms, sets of coordinates, and every refusal.

use super::*;
use image::{DynamicImage, ImageBuffer, ImageFormat};

const RED: [u8; 4] = [255, 0, 0, 255];
const GREEN: [u8; 4] = [0, 255, 0, 255];
const BLUE: [u8; 4] = [0, 0, 255, 255];
const WHITE: [u8; 4] = [255; 4];
/// Red and green above blue and white.
pub(super) const FOUR: [[u8; 4]; 4] = [RED, GREEN, BLUE, WHITE];
const NEAREST: u32 = 9728;

/// A diffuse square with texture 0 as its base colour.
pub(super) fn textured(picture: &[u8], sampler: Value) -> Glb {
    let mut paint = lambert("paint", [1.0; 3]);
    paint["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
    let mut glb = with_coordinates(paint);
    glb.texture(picture, sampler);
    glb
}

/// The colours of the upper left, upper right, lower left and lower right quarter.
fn quarters(scene: &Scene) -> [Vec3; 4] {
    [(-0.25, 0.25), (0.25, 0.25), (-0.25, -0.25), (0.25, -0.25)].map(|(x, y)| point(scene, x, y).look.color)
}

fn colors(texels: [[u8; 4]; 4]) -> [Vec3; 4] {
    texels.map(|[r, g, b, _]| Vec3::new(f32::from(r), f32::from(g), f32::from(b)) / 255.0)
}

#[test]
fn base_colours_come_from_pictures() {
    let scene = load(&textured(&png([2, 2], &FOUR), json!({})));
    quarters(&scene).into_iter().zip(colors(FOUR)).for_each(|(a, b)| close(a, b));
    assert!(scene.features.textures && scene.notes.is_empty(), "{:?}", scene.notes);
    assert_eq!((scene.textures.bytes(), scene.textures.list.len()), (16, 1));
    // Bilinear unless told otherwise; the factor multiplies; codes are sRGB.
    close(point(&scene, 0.0, 0.25).look.color, Vec3::new(0.5, 0.5, 0.0));
    let mut glb = textured(&png([1, 1], &[[188, 188, 0, 255]]), json!({}));
    glb.json["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.5, 1.0, 1.0, 1.0]);
    let color = point(&load(&glb), 0.1, 0.1).look.color;
    assert!((color - Vec3::new(0.25144, 0.50289, 0.0)).length() < 1e-4, "{color}");
    let scene = load(&textured(&png([2, 2], &FOUR), json!({ "magFilter": NEAREST })));
    close(point(&scene, -0.01, 0.01).look.color, Vec3::X);
}

#[test]
fn every_kind_of_png_and_jpeg_is_read() {
    let show = |bytes: &[u8]| point(&load(&textured(bytes, json!({}))), 0.1, 0.1).look.color;
    let kinds: [DynamicImage; 8] = [
        ImageBuffer::from_pixel(2, 3, image::Luma([255u8])).into(),
        ImageBuffer::from_pixel(2, 3, image::LumaA([255u8, 7])).into(),
        ImageBuffer::from_pixel(2, 3, image::Rgb([255u8; 3])).into(),
        ImageBuffer::from_pixel(2, 3, image::Rgba([255u8; 4])).into(),
        ImageBuffer::from_pixel(2, 3, image::Luma([65535u16])).into(),
        ImageBuffer::from_pixel(2, 3, image::LumaA([65535u16, 7])).into(),
        ImageBuffer::from_pixel(2, 3, image::Rgb([65535u16; 3])).into(),
        ImageBuffer::from_pixel(2, 3, image::Rgba([65535u16; 4])).into(),
    ];
    for picture in &kinds {
        close(show(&encoded(picture, ImageFormat::Png)), Vec3::ONE);
    }
    for picture in [&kinds[0], &kinds[2]] {
        close(show(&encoded(picture, ImageFormat::Jpeg)), Vec3::ONE);
    }
    close(show(PALETTE), Vec3::Y);
}

/// One green texel of a palette of two colours, one bit per texel.
const PALETTE: &[u8] = &[
    137, 80, 78, 71, 13, 10, 26, 10, 0, 0, 0, 13, 73, 72, 68, 82, 0, 0, 0, 1, 0, 0, 0, 1, 1, 3, 0, 0, 0, 37, 219, 86, 202, 0, 0, 0, 6, 80,
    76, 84, 69, 255, 0, 0, 0, 255, 0, 210, 135, 239, 113, 0, 0, 0, 10, 73, 68, 65, 84, 120, 218, 99, 104, 0, 0, 0, 130, 0, 129, 218, 69, 8,
    59, 0, 0, 0, 0, 73, 69, 78, 68, 174, 66, 96, 130,
];

#[test]
fn pictures_are_found_in_uris_and_beside_the_file() {
    let mut glb = textured(&png([2, 2], &FOUR), json!({}));
    let uri = format!("data:image/png;base64,{}", base64(&png([2, 2], &FOUR)));
    glb.json["images"][0] = json!({ "uri": uri });
    close(quarters(&load(&glb))[1], Vec3::Y);
    glb.json["images"][0] = json!({ "uri": "a%20picture.png", "name": "bark" });
    says(&error(&glb), &["material 1 'paint': its base colour texture: image 0 'bark'", "in another file, 'a%20picture.png'"]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.glb");
    std::fs::write(&path, glb.bytes()).unwrap();
    says(&gltf::load(&path, &Overrides::default()).unwrap_err().to_string(), &["image 0 'bark'", "a picture.png", "put it there"]);
    std::fs::write(folder.path().join("a picture.png"), png([2, 2], &FOUR)).unwrap();
    close(quarters(&gltf::load(&path, &Overrides::default()).unwrap())[1], Vec3::Y);
}

#[test]
fn samplers_say_what_lies_beyond_the_edge() {
    let at = |sampler: Value| {
        let mut glb = textured(&png([2, 2], &FOUR), sampler);
        // One picture to the right and one down.
        let uvs = glb.floats(&CORNERS.map(|[u, v]| [u + 1.0, v + 1.0]));
        glb.attribute(1, "TEXCOORD_0", uvs);
        quarters(&load(&glb))
    };
    let [r, g, b, w] = colors(FOUR);
    assert_eq!(at(json!({ "magFilter": NEAREST })), [r, g, b, w]);
    assert_eq!(at(json!({ "magFilter": NEAREST, "wrapS": 33648 })), [g, r, w, b]);
    assert_eq!(at(json!({ "magFilter": NEAREST, "wrapT": 33648 })), [b, w, r, g]);
    assert_eq!(at(json!({ "magFilter": NEAREST, "wrapS": 33071, "wrapT": 33071 })), [w; 4]);
}

#[test]
fn transforms_follow_the_extension() {
    let at = |transform: Value| {
        let mut glb = textured(&png([2, 2], &FOUR), json!({ "magFilter": NEAREST }));
        glb.json["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = json!({ "KHR_texture_transform": transform });
        glb.json["extensionsRequired"] = json!(["KHR_texture_transform"]);
        quarters(&load(&glb))
    };
    let [r, g, b, w] = colors(FOUR);
    assert_eq!(at(json!({})), [r, g, b, w]);
    assert_eq!(at(json!({ "offset": [0.5, 0.0] })), [g, r, w, b]);
    assert_eq!(at(json!({ "offset": [0.0, 1.0], "scale": [1.0, -1.0] })), [b, w, r, g]);
    // The extension's own example: the lower left quarter alone.
    let example = json!({ "offset": [0.0, 1.0], "rotation": std::f32::consts::FRAC_PI_2, "scale": [0.5, 0.5] });
    assert_eq!(at(example), [b; 4]);
    // The coordinates turn counter-clockwise: the picture clockwise, about its upper left corner.
    assert_eq!(at(json!({ "rotation": std::f32::consts::FRAC_PI_2 })), [b, r, w, g]);
}

#[test]
fn either_set_of_coordinates_can_be_meant() {
    let mut glb = textured(&png([2, 2], &FOUR), json!({ "magFilter": NEAREST }));
    let uvs = glb.floats(&CORNERS.map(|[u, v]| [1.0 - u, v]));
    glb.attribute(1, "TEXCOORD_1", uvs);
    let [r, g, b, w] = colors(FOUR);
    assert_eq!(quarters(&load(&glb)), [r, g, b, w]);
    let info = "/materials/1/pbrMetallicRoughness/baseColorTexture";
    *glb.json.pointer_mut(info).unwrap() = json!({ "index": 0, "texCoord": 1 });
    let scene = load(&glb);
    assert_eq!(quarters(&scene), [g, r, w, b]);
    // Only the set in use is kept.
    assert_eq!(scene.attributes.uvs.len(), 2);
    let transform = json!({ "KHR_texture_transform": { "texCoord": 0 } });
    *glb.json.pointer_mut(info).unwrap() = json!({ "index": 0, "texCoord": 1, "extensions": transform });
    assert_eq!(quarters(&load(&glb)), [r, g, b, w]);
    *glb.json.pointer_mut(info).unwrap() = json!({ "index": 0, "texCoord": 5 });
    let scene = load(&glb);
    assert_eq!(quarters(&scene), [r, g, b, w]);
    assert_eq!(scene.notes, ["Texture coordinates beyond set 1 are not read, set 0 stands in for them: 'paint'."]);
}

#[test]
fn an_image_is_stored_once() {
    let mut glb = textured(&png([2, 2], &FOUR), json!({}));
    let second = glb.push("textures", json!({ "source": 0 }));
    let mut other = lambert("other", [1.0; 3]);
    other["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": second });
    other["emissiveTexture"] = json!({ "index": 0 });
    other["emissiveFactor"] = json!([1.0, 1.0, 1.0]);
    other["normalTexture"] = json!({ "index": 0 });
    let other = glb.material(other);
    glb.object("other", &Shape::quad(SQUARE), other);
    let scene = load(&glb);
    assert_eq!(scene.textures.bytes(), 16);
    // The same use of it is one texture; as numbers instead of colours it is another.
    assert_eq!(scene.textures.list.len(), 2);
}

#[test]
fn roughness_metal_and_emission_come_from_pictures() {
    let mut material = json!({ "name": "m", "pbrMetallicRoughness": { "metallicFactor": 0.5, "roughnessFactor": 0.5 } });
    material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = json!({ "index": 0 });
    material["emissiveTexture"] = json!({ "index": 1 });
    material["emissiveFactor"] = json!([1.0, 0.5, 1.0]);
    let mut glb = with_coordinates(material);
    // Red (occlusion) does not count.
    glb.texture(&png([1, 1], &[[17, 51, 204, 255]]), json!({}));
    glb.texture(&png([1, 2], &[[255, 255, 0, 255], [0, 0, 0, 255]]), json!({ "magFilter": NEAREST }));
    let scene = load(&glb);
    let at = point(&scene, 0.1, 0.25);
    assert_eq!(scene.materials[at.material as usize].kind, COAT);
    assert!((at.look.roughness - 0.1).abs() < 1e-6 && (at.look.metallic - 0.4).abs() < 1e-6, "{:?}", at.look);
    let emitted = |y: f64| {
        let at = point(&scene, 0.1, y);
        scene.emission_factor::<General>(at.triangle, at.material, at.look.barycentric) * seen(&scene).emission
    };
    assert_eq!((emitted(0.25), emitted(-0.25)), (Vec3::new(1.0, 0.5, 0.0), Vec3::ZERO));
    // A black emissive texture emits nothing.
    glb.json["images"][1]["bufferView"] = json!(glb.view(&png([1, 1], &[[0, 0, 0, 255]])));
    assert!(load(&glb).triangles.iter().filter(|t| t.material == 1).all(|t| t.light == NONE));
    // And where that is all that could, there is no light: the studio's stands in.
    glb.json["materials"][0].as_object_mut().unwrap().remove("emissiveFactor");
    let dark = load(&glb);
    assert!(dark.features.environment && dark.notes.iter().any(|note| note.contains("studio")), "{:?}", dark.notes);
}

#[test]
fn foreign_formats_are_named_and_left_out() {
    let note = |change: &dyn Fn(&mut Glb)| {
        let mut glb = textured(&png([2, 2], &FOUR), json!({}));
        change(&mut glb);
        let scene = load(&glb);
        close(point(&scene, 0.1, 0.1).look.color, Vec3::ONE);
        assert_eq!(scene.textures.bytes(), 0);
        scene.notes.join(" ")
    };
    for extension in ["KHR_texture_basisu", "EXT_texture_webp"] {
        let text = note(&|glb| {
            glb.json["textures"][0] = json!({ "extensions": { extension: { "source": 0 } } });
            glb.json["extensionsUsed"] = json!([extension]);
        });
        assert_eq!(text, format!("The base colour texture was ignored, as {extension} images are not read: 'paint'."));
        let mut glb = textured(&png([2, 2], &FOUR), json!({}));
        glb.json["extensionsRequired"] = json!([extension]);
        says(&error(&glb), &[&format!("requires the extension {extension}")]);
    }
    let headers: [(&str, &[u8]); 4] =
        [("WebP", b"RIFF\x10\0\0\0WEBPVP8 "), ("KTX", b"\xabKTX 20\xbb"), ("DDS", b"DDS \x7c"), ("AVIF", b"\0\0\0\x20ftypavif")];
    for (format, bytes) in headers {
        let text = note(&|glb| glb.json["images"][0]["bufferView"] = json!(glb.view(bytes)));
        says(&text, &[&format!("as {format} images are not read: 'paint'")]);
    }
    // With a PNG to fall back on, that is read.
    let mut glb = textured(&png([2, 2], &FOUR), json!({}));
    glb.json["textures"][0]["extensions"] = json!({ "KHR_texture_basisu": { "source": 7 } });
    glb.json["extensionsUsed"] = json!(["KHR_texture_basisu", "KHR_materials_specular"]);
    let scene = load(&glb);
    close(quarters(&scene)[1], Vec3::Y);
    assert_eq!(scene.notes, ["Ignored: the extension KHR_texture_basisu."]);
}

#[test]
fn bad_textures_are_named() {
    let after = |change: &dyn Fn(&mut Glb)| {
        let mut glb = textured(&png([2, 2], &FOUR), json!({ "name": "s" }));
        glb.json["images"][0]["name"] = json!("bark");
        change(&mut glb);
        error(&glb)
    };
    let replaced = |path: &str, value: Value| after(&|glb| *glb.json.pointer_mut(path).unwrap() = value.clone());
    let material = "material 1 'paint': its base colour texture:";
    says(&replaced("/materials/1/pbrMetallicRoughness/baseColorTexture", json!({ "index": 4 })), &[material, "texture 4 does not exist"]);
    says(&replaced("/textures/0", json!({ "source": 3 })), &[material, "image 3 does not exist"]);
    says(&replaced("/textures/0", json!({})), &[material, "texture 0 has no image"]);
    says(&replaced("/textures/0/sampler", json!(9)), &[material, "sampler 9 does not exist"]);
    says(&replaced("/samplers/0", json!({ "wrapS": 1 })), &[material, "sampler 0 has an unknown mode"]);
    says(&replaced("/samplers/0", json!({ "magFilter": 1 })), &[material, "sampler 0 has an unknown mode"]);
    says(&replaced("/images/0", json!({ "name": "bark" })), &[material, "image 0 'bark'", "neither a file nor a buffer view"]);
    says(&replaced("/images/0/bufferView", json!(99)), &[material, "image 0 'bark': buffer view 99 does not exist"]);
    says(&replaced("/images/0/bufferView", json!(0)), &[material, "image 0 'bark' is neither a PNG nor a JPEG picture; convert it"]);
    let with = |bytes: Vec<u8>| after(&move |glb| glb.json["images"][0]["bufferView"] = json!(glb.view(&bytes)));
    let whole = png([2, 2], &FOUR);
    says(&with(whole[..20].to_vec()), &["image 0 'bark' cannot be decoded", "save the picture anew"]);
    says(&with(whole[..whole.len() - 20].to_vec()), &["test.glb: image 0 'bark' cannot be decoded"]);
    let mut huge = whole;
    huge[16..24].copy_from_slice(&[0, 1, 0, 0, 0, 1, 0, 0]);
    let crc = crc32(&huge[12..29]).to_be_bytes();
    huge[29..33].copy_from_slice(&crc);
    says(&with(huge), &["image 0 'bark' has 65536×65536 texels, 1 to 16384 a side can be read"]);
    for scale in [1e39, -2e9] {
        let transform = json!({ "index": 0, "extensions": { "KHR_texture_transform": { "scale": [scale, 1.0] } } });
        says(
            &replaced("/materials/1/pbrMetallicRoughness/baseColorTexture", transform),
            &[material, "its KHR_texture_transform is not finite or above 1e9"],
        );
    }
    says(
        &after(&|glb| glb.json["materials"][1]["alphaMode"] = json!("GLASS")),
        &["material 1 'paint': its alphaMode is none of OPAQUE, MASK and BLEND"],
    );
}

/// The check sum of PNG's chunks.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes
        .iter()
        .fold(!0, |crc, &byte| (0..8).fold(crc ^ u32::from(byte), |crc, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 }))
}
