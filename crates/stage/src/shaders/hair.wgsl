// Brows, lashes and hair, a hair at a time: how much of one covers a pixel.

// Brows: an arch over each eye, thinner outwards, of hairs that lean outwards. `p` is relative to
// the eyes' midpoint in units of their span.
fn brows(p: vec3f) -> f32 {
    let side = abs(p.x);
    let along = (side - 0.17) / 0.72;
    let arch = 0.350 + 0.150 * sin(clamp(along, 0.0, 1.2) * 2.2) - 0.16 * along * along;
    let thick = mix(0.088, 0.034, clamp(along, 0.0, 1.0));
    let off = (p.y - arch) / thick;
    // Hairs stand up near the nose and lie along the arch further out.
    let turn = mix(1.25, 0.25, clamp(along * 1.3, 0.0, 1.0));
    let lean = vec2f(cos(turn) * side + sin(turn) * p.y, cos(turn) * p.y - sin(turn) * side);
    let hairs = 0.5 * noise(lean * vec2f(22.0, 150.0)) + 0.5 * noise(lean * vec2f(40.0, 330.0) + 7.0);
    let body = 1.0 - smoothstep(0.15, 1.15, abs(off) + 0.45 * (hairs - 0.5));
    let ends = smoothstep(-0.10, 0.20, along) * (1.0 - smoothstep(0.70, 1.04, along));
    return clamp(body * ends * (0.62 + 0.62 * hairs), 0.0, 0.90);
}

// Lashes that come as bands: hairs side by side that end at different lengths. `at` is neutral.
fn lash(at: vec4f) -> f32 {
    let unit = scene.eyes_middle.w;
    let side = sign(at.x - scene.eyes_middle.x);
    let arm = (at.xy - scene.eyes_middle.xy) / unit - vec2f(0.5 * side, -0.06);
    let around = atan2(arm.y, arm.x);
    let hair = noise(vec2f(around * 42.0, 3.0)) * 0.7 + noise(vec2f(around * 97.0, 8.0)) * 0.3;
    let root = exp(-at.w * at.w * 30.0);
    let tips = 1.0 - smoothstep(0.10 + 0.75 * hair, 0.30 + 0.80 * hair, at.w);
    let band = clamp(0.80 * root + 0.75 * tips * smoothstep(0.25, 0.60, hair), 0.0, 0.92);
    // Those of the lower lid are short and sparse.
    let lower = (0.30 * root + 0.40 * smoothstep(0.45, 0.70, hair)) * (1.0 - smoothstep(0.08, 0.34, at.w));
    return select(band, lower, arm.y < 0.0);
}

fn on_brow(p: vec3f) -> bool {
    return p.z > 0.0 && p.y > 0.1 && p.y < 0.68 && abs(p.x) < 0.92;
}

// Hairs side by side, 0 between them and 1 on one; `p` as for `brows`.
fn strands(p: vec3f) -> f32 {
    let side = abs(p.x);
    var across: f32;
    if on_brow(p) {
        // Brows: hairs stand up near the nose and lie along the arch further out.
        let turn = mix(1.25, 0.30, clamp((side - 0.15) * 1.8, 0.0, 1.0));
        across = 0.8 * (cos(turn) * p.y - sin(turn) * side);
    } else {
        // Combed back from the face, to where the crown falls off behind.
        let q = p - vec3f(0.0, -0.1, -1.1);
        across = atan2(side, dot(q, vec3f(0.0, 0.75, 0.66)));
    }
    let along = 0.7 * p.z + 1.3 * p.y;
    return 0.55 * noise(vec2f(across * 75.0, along * 2.0)) + 0.45 * noise(vec2f(across * 190.0 + 11.0, along * 3.0));
}
