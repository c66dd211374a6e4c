// Creases of the skin that is pressed together, placed in the neutral pose: `p` is relative to the
// eyes' midpoint in units of their span. Each family of lines has its place and its direction, as
// anatomists draw them (lines across the forehead from the frontalis, upright ones between the brows
// from the corrugator, across the nose's root from the procerus, fans beside the eyes from the
// orbicularis, the nasolabial fold); how deep they are is how much the skin is pressed across them.

// What a family adds: slope across and up (xy), darkness (z).
fn lines(strain: vec3f, across: vec2f, phase: f32, place: f32) -> vec3f {
    let pressed = -(strain.x * across.x * across.x + strain.y * across.y * across.y + 2.0 * strain.z * across.x * across.y);
    let deep = place * smoothstep(0.015, 0.26, pressed);
    // Narrow valleys between broad folds.
    let turn = 2.0 * PI * phase;
    let valley = 0.5 + 0.5 * cos(turn);
    let sharp = valley * valley * valley;
    return deep * vec3f(across * (sin(turn) * sharp), sharp * valley);
}

fn creases(p: vec3f, strain: vec3f) -> vec3f {
    let side = abs(p.x);
    let left = select(-1.0, 1.0, p.x > 0.0);
    let q = vec2f(side, p.y);
    let wander = noise(p.xy * 4.0 + 3.0) - 0.5;
    // Forehead: arcs over the brows.
    let forehead = smoothstep(0.46, 0.62, p.y) * (1.0 - smoothstep(0.95, 1.25, p.y)) * (1.0 - smoothstep(0.6, 1.0, side));
    let round = sqrt(side * side + 0.03);
    let arc = p.y - 0.05 * cos(6.0 * (round - 0.45)) + 0.08 * wander;
    var sum = lines(strain, vec2f(0.0, 1.0), arc / 0.155, forehead);
    // Between the brows, one beside the middle on each side.
    let frown = near(q, vec2f(0.11, 0.34), vec2f(0.14, 0.22));
    sum += lines(strain, vec2f(left, 0.0), (side - 0.10 - 0.06 * (p.y - 0.34) + 0.04 * wander) / 0.21, 1.5 * frown);
    // Across the nose's root, falling away at its sides.
    let root = near(q, vec2f(0.0, -0.06), vec2f(0.30, 0.24));
    sum += lines(strain, normalize(vec2f(left * 0.5 * min(side / 0.2, 1.0), 1.0)), (p.y + 0.5 * round + 0.03 * wander) / 0.085, 1.4 * root);
    // A fan from the eye's outer corner.
    let arm = q - vec2f(0.70, -0.04);
    let away = length(arm);
    let around = atan2(arm.y, arm.x);
    let fan = smoothstep(0.06, 0.14, away) * (1.0 - smoothstep(0.22, 0.42, away)) * (1.0 - smoothstep(0.7, 1.2, abs(around)));
    sum += lines(strain, vec2f(-left * arm.y, arm.x) / max(away, 1e-3), (around + 0.3 * wander) / 0.42, 1.6 * fan);
    // Under the lower lid, round the eye.
    let below = q - vec2f(0.50, 0.0);
    let bag = near(below, vec2f(0.0, -0.36), vec2f(0.26, 0.12));
    let out = normalize(below + vec2f(0.0, 1e-4));
    sum += lines(strain, vec2f(left * out.x, out.y), (length(below) + 0.03 * wander) / 0.10, 0.8 * bag);
    // From the nose's wing past the corner of the mouth.
    let fall = (-0.66 - p.y) / 0.55;
    let off = side - (0.30 + 0.27 * fall + 0.05 * fall * fall);
    let fold = (1.0 - smoothstep(0.04, 0.10, abs(off))) * smoothstep(-0.08, 0.12, fall) * (1.0 - smoothstep(0.75, 1.15, fall));
    sum += lines(strain, vec2f(0.88 * left, 0.47), off / 0.38, 1.1 * fold);
    return sum;
}
