// What a vertex needs of settings and shape: twin of src/bdpt/context.rs.

fn survival(v: Vertex) -> f32 {
    if control.params.roulette == 0u {
        return 1.0;
    }
    let material = load_material(v.material);
    if HAS_TEXTURES && material_has(material, VARIES) {
        return survival_of(material, v.look.color, v.look.metallic);
    }
    return material.survival;
}

fn vertex_opacity(v: Vertex) -> f32 {
    if HAS_ALPHA {
        return v.look.opacity;
    }
    return 1.0;
}
