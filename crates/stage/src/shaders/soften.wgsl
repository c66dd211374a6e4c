// Step 4, repeated: one fragment a vertex. The key light's visibility averaged over the vertices
// round each: a shadow's edge spreads over several triangles wherever they are too large to
// follow it, and stays as narrow as the light's penumbra where they are small.
@group(0) @binding(0) var vertices: texture_2d<u32>;
@group(0) @binding(1) var rings: texture_2d<u32>;
@group(0) @binding(2) var surfaces: texture_2d<f32>;

@vertex
fn cover_softened(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return cover(index);
}

@fragment
fn soften(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let texel = vec2u(at.xy);
    let ring = textureLoad(vertices, texel, 0).zw;
    let here = textureLoad(surfaces, texel, 0);
    var sum = 0.0;
    for (var r = ring.x; r < ring.x + ring.y; r++) {
        // Each neighbour once in a closed ring; at an open border one of them is left out.
        let next = textureLoad(rings, list_texel(r), 0).x;
        sum += textureLoad(surfaces, vertex_texel(next), 0).w;
    }
    // A third for the vertex itself, the rest shared by its neighbours.
    let mean = sum / f32(max(ring.y, 1u));
    return vec4f(here.xyz, select(here.w, mix(mean, here.w, 0.333), ring.y > 0u));
}
