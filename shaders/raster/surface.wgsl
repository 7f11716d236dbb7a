// The surfaces of the 3-D view: flat colours under a light at the viewer's head. Only what WebGL2 has, too: vertex buffers
// and one uniform. Depth is reversed, near/depth: 1 just before the viewer, 0 at infinity.

struct Camera {
    right: vec3<f32>,
    // 1/half extent of the picture on the plane at distance 1.
    inverse_x: f32,
    up: vec3<f32>,
    inverse_y: f32,
    axis: vec3<f32>,
    // Distance from which on something is drawn, m.
    near: f32,
    position: vec3<f32>,
    // 1: what faces away is left out, so that one sees into rooms; else 0.
    cull: f32,
}

@group(0) @binding(0) var<uniform> camera: Camera;

struct Surface {
    @builtin(position) clip: vec4<f32>,
    @location(0) color: vec4<f32>,
    @location(1) normal: vec4<f32>,
    @location(2) to_eye: vec3<f32>,
}

// `normal.w`: 0, or how many faces emit, in halves.
@vertex
fn corner(@location(0) position: vec3<f32>, @location(1) color: vec4<f32>, @location(2) normal: vec4<f32>) -> Surface {
    let w = position - camera.position;
    var out: Surface;
    out.clip = vec4<f32>(dot(w, camera.right) * camera.inverse_x, dot(w, camera.up) * camera.inverse_y, camera.near, dot(w, camera.axis));
    out.color = color;
    out.normal = normal;
    out.to_eye = -w;
    return out;
}

@fragment
fn shade(in: Surface) -> @location(0) vec4<f32> {
    let facing = dot(normalize(in.normal.xyz), normalize(in.to_eye));
    if facing < 0.0 && camera.cull > 0.5 {
        discard;
    }
    let emits = in.normal.w > 0.75 || (in.normal.w > 0.25 && facing > 0.0);
    // Calm: what matters is drawn over it.
    let calm = mix(vec3<f32>(dot(in.color.rgb, vec3<f32>(0.3, 0.6, 0.1))), in.color.rgb, 0.6) * (0.22 + 0.5 * abs(facing));
    // What shines is bright, but its shape can be told.
    let bright = in.color.rgb * (0.75 + 0.25 * abs(facing));
    return vec4<f32>(select(calm, bright, emits), in.color.a);
}
