// Pass 3: one fragment a vertex. The normal of the deformed surface, and how much of the key light
// reaches it.
@group(0) @binding(0) var<uniform> scene: Scene;
@group(0) @binding(1) var vertices: texture_2d<u32>;
@group(0) @binding(2) var rings: texture_2d<u32>;
@group(0) @binding(3) var positions: texture_2d<f32>;
@group(0) @binding(4) var shadow: texture_depth_2d;
@group(0) @binding(5) var shadow_sampler: sampler_comparison;

@vertex
fn cover_surface(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return cover(index);
}

// Sum of cross products over the squared lengths of both sides: exact on a sphere whatever the
// triangles (Max 1999, "Weights for computing vertex normals from facet normals").
fn ring_normal(position: vec3f, start: u32, count: u32) -> vec3f {
    var sum = vec3f(0.0);
    for (var r = start; r < start + count; r++) {
        let ends = textureLoad(rings, list_texel(r), 0).xy;
        let a = textureLoad(positions, vertex_texel(ends.x), 0).xyz - position;
        let b = textureLoad(positions, vertex_texel(ends.y), 0).xyz - position;
        // 1e-24: sides under a micrometre give no direction.
        sum += cross(a, b) / max(dot(a, a) * dot(b, b), 1e-24);
    }
    let size = length(sum);
    return select(vec3f(0.0, 0.0, 1.0), sum / size, size > 0.0);
}

// Sixteen comparisons on a disc of 9 mm: the penumbra of a large soft box.
fn key_visibility(position: vec3f, normal: vec3f) -> f32 {
    let unit = scene.eyes_middle.w;
    let lit = scene.light_from_world * vec4f(position + normal * (0.030 * unit), 1.0);
    let at = lit.xy * vec2f(0.5, -0.5) + 0.5;
    var open = 0.0;
    for (var i = 0u; i < 16u; i++) {
        // Vogel's disc: equal areas, golden angle.
        let radius = sqrt((f32(i) + 0.5) / 16.0) * 0.024;
        let angle = f32(i) * 2.3999632;
        let tap = at + radius * vec2f(cos(angle), sin(angle));
        open += textureSampleCompareLevel(shadow, shadow_sampler, tap, lit.z);
    }
    return open / 16.0;
}

@fragment
fn surface(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let texel = vec2u(at.xy);
    let vertex = textureLoad(vertices, texel, 0);
    let position = textureLoad(positions, texel, 0).xyz;
    let normal = ring_normal(position, vertex.z, vertex.w);
    return vec4f(normal, key_visibility(position, normal));
}
