// At loading, once a direction of the sky: how open each vertex of the neutral head lies.
@group(0) @binding(0) var<uniform> scene: Scene;
@group(0) @binding(1) var positions: texture_2d<f32>;
@group(0) @binding(2) var shadow: texture_depth_2d;
@group(0) @binding(3) var shadow_sampler: sampler_comparison;
@group(0) @binding(4) var surfaces: texture_2d<f32>;

@vertex
fn cover_occlusion(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return cover(index);
}

// One direction of the sky, added to the others: light that arrives, light that would arrive with
// nothing in the way. The direction is that of the scene's light.
@fragment
fn occlusion(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let texel = vec2u(at.xy);
    let position = textureLoad(positions, texel, 0).xyz;
    let normal = textureLoad(surfaces, texel, 0).xyz;
    let towards = -normalize(vec3f(scene.light_from_world[0].z, scene.light_from_world[1].z, scene.light_from_world[2].z));
    let facing = max(dot(normal, towards), 0.0);
    let lit = scene.light_from_world * vec4f(position + normal * (0.020 * scene.eyes_middle.w), 1.0);
    let tap = lit.xy * vec2f(0.5, -0.5) + 0.5;
    let open = textureSampleCompareLevel(shadow, shadow_sampler, tap, lit.z);
    return vec4f(facing * open, facing, 0.0, 0.0);
}
