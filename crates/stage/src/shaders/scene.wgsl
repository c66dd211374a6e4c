// Shared declarations: what all passes over the head know. Layout: `layouts.rs`, `Scene`.
const VERTEX_TABLE_WIDTH: u32 = 256u;
const LIST_TABLE_WIDTH: u32 = 1024u;

struct Gaze {
    rows: array<vec4f, 3>,
    iris: vec4f,
}

struct Scene {
    clip_from_world: mat4x4f,
    light_from_world: mat4x4f,
    camera: vec4f,
    eyes_middle: vec4f,
    mouth: vec4f,
    lips: vec4f,
    skin: vec4f,
    brows: vec4f,
    light: vec4f,
    body: vec4f,
    gaze: array<Gaze, 16>,
}

// The key light stands above, in front and to the person's right.
const KEY: vec3f = vec3f(-0.4364, 0.5455, 0.7155);

fn vertex_texel(index: u32) -> vec2u {
    return vec2u(index % VERTEX_TABLE_WIDTH, index / VERTEX_TABLE_WIDTH);
}

fn list_texel(index: u32) -> vec2u {
    return vec2u(index % LIST_TABLE_WIDTH, index / LIST_TABLE_WIDTH);
}

// One triangle that covers a table.
fn cover(index: u32) -> vec4f {
    let corner = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4f(corner * 2.0 - 1.0, 0.0, 1.0);
}

// Directions on the skin at a normal: across the face towards the person's left, and upwards.
fn skin_frame(normal: vec3f) -> mat2x3f {
    let across = vec3f(normal.z, 0.0, -normal.x);
    // 1e-4: on the crown no direction is across.
    let left = across / max(length(across), 1e-4);
    return mat2x3f(left, cross(normal, left));
}
