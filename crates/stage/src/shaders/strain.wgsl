// Step 5: one fragment a vertex. How the skin is stretched and pressed: the mean over the triangles
// round a vertex of Green's strain E = (F'F - 1) / 2 of their way from the neutral head to the pose
// (Bonet and Wood 2008, section 4.5), across the face, along it, and between the two. Less than 0:
// pressed together.
@group(0) @binding(0) var vertices: texture_2d<u32>;
@group(0) @binding(1) var rings: texture_2d<u32>;
@group(0) @binding(2) var positions: texture_2d<f32>;
@group(0) @binding(3) var neutral: texture_2d<f32>;

@vertex
fn cover_strain(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return cover(index);
}

@fragment
fn strain(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let texel = vec2u(at.xy);
    let ring = textureLoad(vertices, texel, 0).zw;
    let now = textureLoad(positions, texel, 0).xyz;
    let rest = textureLoad(neutral, texel, 0).xyz;
    var sum = vec4f(0.0);
    for (var r = ring.x; r < ring.x + ring.y; r++) {
        let ends = textureLoad(rings, list_texel(r), 0).xy;
        let a0 = textureLoad(neutral, vertex_texel(ends.x), 0).xyz - rest;
        let b0 = textureLoad(neutral, vertex_texel(ends.y), 0).xyz - rest;
        let a = textureLoad(positions, vertex_texel(ends.x), 0).xyz - now;
        let b = textureLoad(positions, vertex_texel(ends.y), 0).xyz - now;
        let normal = cross(a0, b0);
        let area = length(normal);
        // Slivers (a corner under 0.06 degrees) and triangles of a square micrometre say nothing.
        if area > max(1e-3 * length(a0) * length(b0), 1e-12) {
            let frame = skin_frame(normal / area);
            let rest2 = mat2x2f(a0 * frame, b0 * frame);
            let det = determinant(rest2);
            let inverse = mat2x2f(rest2[1].y, -rest2[0].y, -rest2[1].x, rest2[0].x) * (1.0 / det);
            let metric = mat2x2f(dot(a, a), dot(a, b), dot(a, b), dot(b, b));
            let stretch = transpose(inverse) * metric * inverse;
            let green = 0.5 * vec3f(stretch[0].x - 1.0, stretch[1].y - 1.0, stretch[1].x);
            sum += area * vec4f(green, 1.0);
        }
    }
    return vec4f(clamp(sum.xyz / max(sum.w, 1e-12), vec3f(-1.0), vec3f(1.0)), 0.0);
}
