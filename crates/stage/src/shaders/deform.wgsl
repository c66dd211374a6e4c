// Pass 1: one fragment a vertex. Position = neutral + sum of weight * delta over the blendshapes
// that move this vertex, then the rigid turn of its eyeball, then that of the head.
struct EyeballPose {
    rotation: array<vec4f, 3>,
    centre: vec4f,
}

struct Pose {
    // Columns of the head's rotation; where it is turned about, and below which height it is not.
    head: array<vec4f, 3>,
    pivot: vec4f,
    eyeballs: array<EyeballPose, 16>,
    weights: array<vec4f, 512>,
}

@group(0) @binding(0) var<uniform> pose: Pose;
@group(0) @binding(1) var neutral: texture_2d<f32>;
@group(0) @binding(2) var vertices: texture_2d<u32>;
@group(0) @binding(3) var entries: texture_2d<f32>;

@vertex
fn cover_positions(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return cover(index);
}

@fragment
fn deform(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let texel = vec2u(at.xy);
    let vertex = textureLoad(vertices, texel, 0);
    var position = textureLoad(neutral, texel, 0).xyz;
    let end = vertex.x + (vertex.y & 0xffffu);
    for (var e = vertex.x; e < end; e++) {
        let entry = textureLoad(entries, list_texel(e), 0);
        let shape = u32(entry.w);
        position += pose.weights[shape >> 2u][shape & 3u] * entry.xyz;
    }
    let eye = vertex.y >> 16u;
    if eye > 0u {
        let ball = pose.eyeballs[eye - 1u];
        let arm = position - ball.centre.xyz;
        position = ball.centre.xyz + ball.rotation[0].xyz * arm.x + ball.rotation[1].xyz * arm.y
            + ball.rotation[2].xyz * arm.z;
    }
    // The neck bends: what lies lower turns less.
    let share = smoothstep(pose.pivot.w, pose.head[0].w, textureLoad(neutral, texel, 0).y);
    let arm = position - pose.pivot.xyz;
    let turned = pose.pivot.xyz + pose.head[0].xyz * arm.x + pose.head[1].xyz * arm.y
        + pose.head[2].xyz * arm.z;
    return vec4f(mix(position, turned, share), 1.0);
}
