// Last pass, for targets that store bytes as they are: from linear light to sRGB.
@group(0) @binding(0) var picture: texture_2d<f32>;

@vertex
fn cover_picture(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return cover(index);
}

// IEC 61966-2-1.
@fragment
fn encode(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let light = textureLoad(picture, vec2u(at.xy), 0).rgb;
    let bright = 1.055 * pow(max(light, vec3f(0.0031308)), vec3f(1.0 / 2.4)) - 0.055;
    return vec4f(select(bright, 12.92 * light, light <= vec3f(0.0031308)), 1.0);
}
