// Steps 2 and 6: the head seen by the key light (depth only), and the picture.
@group(0) @binding(0) var<uniform> scene: Scene;
@group(0) @binding(1) var positions: texture_2d<f32>;
@group(0) @binding(2) var surfaces: texture_2d<f32>;
@group(0) @binding(3) var neutral: texture_2d<f32>;
@group(0) @binding(4) var occlusions: texture_2d<f32>;
@group(0) @binding(5) var strains: texture_2d<f32>;
// The surface's picture; white where it has none.
@group(1) @binding(0) var picture: texture_2d<f32>;
@group(1) @binding(1) var picture_sampler: sampler;

// Layout: `layouts.rs`, `Material`.
const MATERIAL_SKIN: u32 = 0u;
const MATERIAL_PAINTED_SKIN: u32 = 1u;
const MATERIAL_TEETH: u32 = 2u;
const MATERIAL_TONGUE: u32 = 3u;
const MATERIAL_SOCKET: u32 = 4u;
const MATERIAL_HAIR: u32 = 5u;
const MATERIAL_CLOTH: u32 = 6u;
const MATERIAL_LASHES: u32 = 7u;
const MATERIAL_EYE: u32 = 8u;

const PI: f32 = 3.14159265;
const KEY_LIGHT: vec3f = vec3f(2.05, 1.93, 1.78);
// Where the key light is mirrored in the eyes: lower than it stands, as a photographer's reflector,
// so that the upper lid does not cover it.
const CATCH: vec3f = vec3f(-0.3482, 0.3383, 0.8743);
const FILL: vec3f = vec3f(0.7071, 0.1414, 0.6928);
const FILL_LIGHT: vec3f = vec3f(0.46, 0.50, 0.56);
const RIM_LEFT: vec3f = vec3f(-0.8165, 0.3266, -0.4763);
const RIM_RIGHT: vec3f = vec3f(0.8018, 0.3563, -0.4800);
const RIM_LIGHT: vec3f = vec3f(0.62, 0.68, 0.78);
const SKY: vec3f = vec3f(0.50, 0.52, 0.55);
const GROUND: vec3f = vec3f(0.24, 0.21, 0.19);

@vertex
fn depth_from_light(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return scene.light_from_world * textureLoad(positions, vertex_texel(index), 0);
}

struct Point {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    // Normal; visibility of the key light.
    @location(1) surface: vec4f,
    // Neutral position; how far along a lash, or in from the hair's border.
    @location(2) neutral: vec4f,
    // Base colour; part of the sky that the neutral head leaves open here.
    @location(3) colour: vec4f,
    @location(4) @interpolate(flat) material: u32,
    // Place in the picture.
    @location(5) uv: vec2f,
    // As `strain.wgsl` computed it.
    @location(6) strain: vec3f,
}

@vertex
fn project(@builtin(vertex_index) index: u32, @location(0) colour: vec4f, @location(1) uv: vec2f) -> Point {
    let texel = vertex_texel(index);
    let position = textureLoad(positions, texel, 0);
    var out: Point;
    out.clip = scene.clip_from_world * position;
    out.position = position.xyz;
    out.surface = textureLoad(surfaces, texel, 0);
    out.neutral = textureLoad(neutral, texel, 0);
    let sky = textureLoad(occlusions, texel, 0).xy;
    out.colour = vec4f(colour.rgb * colour.rgb, sky.x / max(sky.y, 1e-3));
    out.material = u32(colour.a * 255.0 + 0.5);
    out.uv = uv;
    out.strain = textureLoad(strains, texel, 0).xyz;
    return out;
}

// ---- light ----

struct Finish {
    albedo: vec3f,
    roughness: f32,
    // Reflectance seen straight on.
    specular: f32,
    // How far light creeps round the terminator, a channel: soft subsurface falloff.
    wrap: vec3f,
    // Part of the surroundings' light that arrives.
    open: f32,
}

// Trowbridge-Reitz with Schlick's Fresnel and the V of Kelemen and Szirmay-Kalos.
fn gloss(n: vec3f, v: vec3f, l: vec3f, roughness: f32, f0: f32) -> f32 {
    let h = normalize(l + v);
    let ndh = max(dot(n, h), 0.0);
    let ldh = max(dot(l, h), 0.05);
    let a2 = roughness * roughness * roughness * roughness;
    let d = ndh * ndh * (a2 - 1.0) + 1.0;
    let grazing = 1.0 - ldh;
    let g2 = grazing * grazing;
    let fresnel = f0 + (1.0 - f0) * g2 * g2 * grazing;
    return a2 / (PI * d * d) * fresnel / (4.0 * ldh * ldh);
}

// Diffuse light that falls off smoothly past the terminator, normalised to the same total.
fn wrapped(ndl: f32, wrap: vec3f) -> vec3f {
    let x = max((vec3f(ndl) + wrap) / (1.0 + wrap), vec3f(0.0));
    return x * x * (1.0 / (1.0 + wrap)) * (0.35 + 0.65 * wrap) + x * (1.0 - wrap) / (1.0 + wrap);
}

fn all_lights(f: Finish, n: vec3f, v: vec3f, key_visible: f32) -> vec3f {
    let to_key = dot(n, KEY);
    // Where the surface turns from the light the wrapped falloff shades it already.
    let shade = clamp(mix(1.0, key_visible, smoothstep(-0.05, 0.30, to_key)), 0.0, 1.0);
    var key = vec3f(shade);
    if shade < 1.0 {
        // Blood scatters red into a shadow's edge.
        key = pow(key, 1.0 / (1.0 + 1.6 * f.wrap));
    }
    let shine = gloss(n, v, KEY, f.roughness, f.specular) * max(to_key, 0.0) * PI;
    var sum = KEY_LIGHT * key * (f.albedo * wrapped(to_key, f.wrap) + shine);
    sum += FILL_LIGHT * f.open * f.albedo * wrapped(dot(n, FILL), f.wrap);

    let edge = clamp(1.0 - dot(n, v), 0.0, 1.0);
    let e2 = edge * edge;
    let mirror = f.specular + (1.0 - f.roughness) * (1.0 - f.specular) * e2 * e2 * edge;
    sum += mix(GROUND, SKY, n.y * 0.5 + 0.5) * f.open * (f.albedo + mirror * 0.6);
    if edge > 0.25 {
        // The rims come from behind: they graze, and shine the more.
        let left = max(dot(n, RIM_LEFT) + 0.15, 0.0);
        let right = max(dot(n, RIM_RIGHT) + 0.15, 0.0);
        sum += RIM_LIGHT * ((left + right) * (e2 - 0.0625) * f.open) * (f.albedo + 0.35 * edge * e2);
    }
    return sum;
}

// ---- paint for skins without colours, placed in the neutral pose ----

fn hash(p: vec2f) -> f32 {
    let q = fract(p * vec2f(0.1031, 0.1030));
    let r = q + dot(q, q.yx + 33.33);
    return fract((r.x + r.y) * r.x);
}

fn noise(p: vec2f) -> f32 {
    let cell = floor(p);
    let f = fract(p);
    let s = f * f * (3.0 - 2.0 * f);
    let low = mix(hash(cell), hash(cell + vec2f(1.0, 0.0)), s.x);
    let high = mix(hash(cell + vec2f(0.0, 1.0)), hash(cell + vec2f(1.0, 1.0)), s.x);
    return mix(low, high, s.y);
}

fn painted(plain: vec3f, at: vec4f) -> vec3f {
    // Plain colours of files are a pale average; skin is darker and warmer.
    let base = plain * vec3f(0.90, 0.72, 0.63);
    let unit = scene.eyes_middle.w;
    let p = (at.xyz - scene.eyes_middle.xyz) / unit;
    let side = abs(p.x);
    let front = smoothstep(-0.5, 0.0, p.z);
    // Blood under cheeks, nose and chin.
    let cheek = exp(-(dot(vec2f(side - 0.62, p.y + 0.62), vec2f(side - 0.62, p.y + 0.62))) * 9.0);
    let nose = exp(-dot(vec2f(side, p.y + 0.70), vec2f(side, p.y + 0.70)) * 22.0);
    var colour = base * mix(vec3f(1.0), vec3f(1.06, 0.84, 0.82), (0.75 * cheek + 0.55 * nose) * front);
    colour *= 0.96 + 0.08 * noise(p.xy * 26.0);
    if p.y < -0.6 && side < 0.6 {
        colour = mix(colour, base * vec3f(0.74, 0.43, 0.43), 0.85 * lips(at.xyz));
    }
    if p.y > 0.15 && p.y < 0.65 && p.z > 0.0 {
        colour = mix(colour, scene.brows.rgb, brows(p) * scene.brows.w);
    }
    return colour;
}

// Lips: from the line where they part up to a bow and down to an arc.
fn lips(at: vec3f) -> f32 {
    if scene.lips.z <= 0.0 {
        return 0.0;
    }
    let unit = scene.eyes_middle.w;
    let x = abs(at.x - scene.lips.x) / scene.lips.z;
    let y = (at.y - scene.lips.y - scene.lips.w * x * x) / unit;
    let inside = max(1.0 - x * x, 0.0);
    let bow = 0.150 * pow(inside, 0.75) - 0.020 * exp(-x * x * 70.0) + 0.012 * exp(-(x - 0.27) * (x - 0.27) * 60.0);
    let arc = 0.185 * pow(inside, 0.62);
    let soft = 0.016;
    let above = 1.0 - smoothstep(bow - soft, bow + soft, y);
    let below = 1.0 - smoothstep(arc - soft, arc + soft * 1.5, -y);
    let width = 1.0 - smoothstep(0.95, 1.03, x);
    return above * below * width * smoothstep(-0.3, 0.0, (at.z - scene.mouth.z) / unit + 0.3);
}

// ---- eyes ----

fn eye(p: Point, v: vec3f, index: u32) -> vec3f {
    let rows = scene.gaze[index].rows;
    let iris_colour = scene.gaze[index].iris.rgb;
    let arm = p.position - vec3f(rows[0].w, rows[1].w, rows[2].w);
    let local = vec3f(dot(rows[0].xyz, arm), dot(rows[1].xyz, arm), dot(rows[2].xyz, arm));
    let seen = vec3f(dot(rows[0].xyz, v), dot(rows[1].xyz, v), dot(rows[2].xyz, v));
    let radius = 1.0 / length(rows[0].xyz);
    let ball = normalize(local);
    // An iris measures 11.8 mm where eyes stand 63 mm apart, whatever the size of the ball.
    let iris_radius = clamp(0.094 * scene.eyes_middle.w / radius, 0.36, 0.50);
    let pupil_radius = 0.37 * iris_radius;
    // The cornea bulges: over the iris the surface is a smaller ball further forward.
    let over = 1.0 - smoothstep(iris_radius * 0.95, iris_radius * 1.30, length(ball.xy));
    let bulged = select(ball, normalize(ball - vec3f(0.0, 0.0, 0.42)), ball.z > 0.42);
    let n_local = normalize(mix(ball, bulged, over));
    let n = normalize(rows[0].xyz * n_local.x + rows[1].xyz * n_local.y + rows[2].xyz * n_local.z);
    // The iris is a disc behind it: follow the refracted ray down.
    let inward = refract(-normalize(seen), n_local, 1.0 / 1.336);
    let disc = sqrt(1.0 - iris_radius * iris_radius) - 0.04;
    let at = ball.xy + inward.xy * max((ball.z - disc) / max(-inward.z, 0.2), 0.0);
    let r = length(at);
    let s = r / iris_radius;

    let angle = atan2(at.y, at.x);
    let fibres = 0.6 * noise(vec2f(angle * 14.0, s * 4.0)) + 0.4 * noise(vec2f(angle * 37.0 + 9.0, s * 8.0));
    var iris = iris_colour * (0.55 + 0.95 * fibres) * mix(1.4, 0.9, smoothstep(0.4, 0.95, s));
    iris = mix(iris, iris_colour * vec3f(1.9, 1.45, 0.8), 0.45 * (1.0 - smoothstep(0.42, 0.62, s)));
    iris *= 1.0 - 0.85 * smoothstep(0.78, 1.0, s);
    iris *= smoothstep(pupil_radius, pupil_radius + 0.03, r);
    // Light that entered the cornea from above gathers on the lower half of the iris.
    iris *= 1.0 + 0.50 * clamp(-at.y / iris_radius, -0.6, 1.0);
    let vein = mix(vec3f(0.84, 0.79, 0.76), vec3f(0.72, 0.47, 0.42), smoothstep(0.60, 1.05, length(ball.xy)));
    let white = 1.0 - smoothstep(-0.035, 0.035, iris_radius - r);

    var f: Finish;
    f.albedo = mix(iris, p.colour.rgb * vein, white);
    f.wrap = vec3f(0.30, 0.22, 0.20);
    f.specular = 0.0;
    f.roughness = 0.5;
    // The lids stand before the ball and take light from its upper and outer parts.
    let outward = arm / radius;
    let upper = smoothstep(0.02, 0.60, outward.y + 0.10 * abs(outward.x));
    f.open = clamp(1.0 - 0.55 * upper - 0.40 * smoothstep(0.45, 0.95, length(outward.xy)), 0.15, 1.0);
    let body = all_lights(f, n, v, p.surface.w) * mix(1.0, f.open, 0.5);

    // The wet surface mirrors a soft box (the key), a dim window (the fill) and the room.
    let mirror = reflect(-v, n);
    let box = smoothstep(0.970, 0.984, dot(mirror, CATCH));
    let window = smoothstep(0.950, 0.985, dot(mirror, FILL));
    let room = mix(GROUND, SKY, mirror.y * 0.5 + 0.5) * f.open;
    let fresnel = 0.025 + 0.5 * pow(clamp(1.0 - dot(n, v), 0.0, 1.0), 5.0);
    return body + (box * 26.0 * KEY_LIGHT + window * 3.0 * FILL_LIGHT + 0.7 * room) * fresnel;
}

// ---- skin of a body that works, placed in the neutral pose ----

fn near(p: vec2f, centre: vec2f, radius: vec2f) -> f32 {
    let d = (p - centre) / radius;
    return exp(-dot(d, d));
}

// Where blood shows: cheeks and nose first, then ears, brow, chin and, in patches, the neck.
fn flushed(albedo: vec3f, p: vec3f) -> vec3f {
    let side = abs(p.x);
    let front = smoothstep(-0.5, 0.2, p.z);
    let cheek = near(vec2f(side, p.y), vec2f(0.62, -0.62), vec2f(0.46, 0.42));
    let nose = near(vec2f(side, p.y), vec2f(0.0, -0.66), vec2f(0.22, 0.26));
    let brow = near(vec2f(side, p.y), vec2f(0.0, 0.75), vec2f(0.8, 0.34));
    let chin = near(vec2f(side, p.y), vec2f(0.0, -1.55), vec2f(0.3, 0.22));
    let ear = smoothstep(1.05, 1.25, side) * (1.0 - smoothstep(0.25, 0.6, p.y)) * smoothstep(-1.3, -0.9, p.y);
    let neck = (1.0 - smoothstep(-2.1, -1.75, p.y)) * smoothstep(0.40, 0.75, noise(p.xy * 3.1 + 5.0));
    let face = 0.24 + 0.85 * cheek + 0.65 * nose + 0.22 * brow + 0.3 * chin;
    let patches = 0.82 + 0.36 * noise(p.xy * 6.0);
    let red = scene.body.x * patches * min(face * front + 0.8 * ear + 0.45 * neck, 1.0);
    return albedo * mix(vec3f(1.0), vec3f(1.08, 0.52, 0.55), 0.72 * red);
}

// How wet the skin is: forehead, temples, nose and upper lip first.
fn wetness(p: vec3f) -> f32 {
    let side = abs(p.x);
    let brow = near(vec2f(side, p.y), vec2f(0.0, 0.95), vec2f(0.95, 0.42));
    let nose = near(vec2f(side, p.y), vec2f(0.0, -0.45), vec2f(0.20, 0.45));
    let lip = near(vec2f(side, p.y), vec2f(0.0, -1.02), vec2f(0.34, 0.12));
    let temple = near(vec2f(side, p.y), vec2f(1.02, 0.2), vec2f(0.3, 0.6));
    let cheek = near(vec2f(side, p.y), vec2f(0.72, -0.7), vec2f(0.4, 0.5));
    return min(0.30 + brow + nose + lip + 0.8 * temple + 0.45 * cheek, 1.0);
}

// Beads of sweat: how a bead tilts the skin across and up (xy), and how much of one is here (z).
fn bead(p: vec3f, size: f32, often: f32) -> vec3f {
    let q = vec2f(p.x + 0.31 * p.z, p.y) / size;
    let cell = floor(q);
    let centre = cell + 0.3 + 0.4 * vec2f(hash(cell), hash(cell + 17.0));
    let radius = 0.16 + 0.16 * hash(cell + 41.0);
    let d = (q - centre) / radius;
    let inside = 1.0 - smoothstep(0.75, 1.0, length(d));
    let there = inside * select(0.0, 1.0, hash(cell + 73.0) < often);
    return vec3f(d * there, there);
}

// ---- picture ----

// A film's response: a soft toe, a long shoulder (Narkowicz 2015, fitted to the ACES curve).
fn film(x: vec3f) -> vec3f {
    return (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
}

fn developed(light: vec3f) -> vec3f {
    return clamp(film(light * scene.light.x * 0.42), vec3f(0.0), vec3f(1.0));
}

const CLAY: vec3f = vec3f(0.34);

@fragment
fn shade(p: Point, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let pixel = length(fwidth(p.neutral.xyz)) / scene.eyes_middle.w;
    let painting = textureSample(picture, picture_sampler, p.uv);
    if painting.a < 0.5 && p.material != MATERIAL_LASHES {
        discard;
    }
    let v = normalize(scene.camera.xyz - p.position);
    var n = normalize(p.surface.xyz);
    var f: Finish;
    let base = p.colour.rgb * painting.rgb;
    f.albedo = base;
    f.roughness = 0.55;
    f.specular = 0.030;
    f.wrap = vec3f(0.10);
    f.open = 1.0;
    var alpha = 1.0;
    // The look of reference clips is one matter, whatever the person's skin and hair.
    let clay = scene.brows.w == 0.0;
    // How far behind the lips, and so how dark.
    let behind = clamp((scene.mouth.z - p.position.z) / scene.mouth.w, 0.0, 1.6);
    if p.material >= MATERIAL_EYE {
        return vec4f(developed(eye(p, v, p.material - MATERIAL_EYE)), 1.0);
    }
    if p.material <= MATERIAL_PAINTED_SKIN {
        var albedo = base;
        if p.material == MATERIAL_PAINTED_SKIN {
            albedo = painted(albedo, p.neutral);
        }
        f.albedo = select(albedo, CLAY, clay) * scene.skin.rgb;
        f.roughness = scene.skin.w;
        f.specular = 0.028;
        // Clay lets no light through.
        f.wrap = select(vec3f(0.42, 0.20, 0.14), vec3f(0.20), clay);
        f.open = 0.25 + 0.75 * clamp(p.colour.a, 0.0, 1.0);
        let at = (p.neutral.xyz - scene.eyes_middle.xyz) / scene.eyes_middle.w;
        // The least principal strain: where nothing is pressed no crease is looked for (`lines`).
        let least = 0.5 * (p.strain.x + p.strain.y) - length(vec2f(0.5 * (p.strain.x - p.strain.y), p.strain.z));
        if at.z > -0.6 && at.y > -1.4 && least < -0.015 {
            let crease = creases(at, p.strain);
            n = normalize(n + 1.1 * (skin_frame(n) * crease.xy));
            f.open *= 1.0 - 0.5 * min(crease.z, 1.0);
            f.albedo *= mix(vec3f(1.0), vec3f(0.80, 0.70, 0.68), min(crease.z, 1.0));
        }
        if !clay && scene.body.x + scene.body.y > 0.0 {
            f.albedo = flushed(f.albedo, at);
            let wet = scene.body.y * wetness(at);
            let beads = bead(at, 0.050, 0.55 * wet * wet) + bead(at + 3.7, 0.031, 0.7 * wet * wet);
            f.albedo *= 1.0 - 0.10 * wet;
            f.roughness = mix(f.roughness, 0.27, wet) - 0.10 * min(beads.z, 1.0);
            f.specular = mix(f.specular, 0.050, wet);
            n = normalize(n + 0.55 * smoothstep(0.0, 0.5, at.z) * vec3f(beads.xy, 0.0));
        }
    } else {
        if !front {
            n = -n;
        }
        if p.material <= MATERIAL_SOCKET {
            f.open = exp(-1.7 * behind);
            f.wrap = vec3f(0.25, 0.12, 0.10);
            f.roughness = select(0.34, 0.28, p.material == MATERIAL_TEETH);
            f.albedo *= select(vec3f(0.85), vec3f(0.80, 0.74, 0.64), p.material == MATERIAL_TEETH);
        }
        if p.material == MATERIAL_HAIR || p.material == MATERIAL_LASHES {
            f.roughness = 0.62;
            f.specular = 0.015;
        }
        if p.material == MATERIAL_HAIR {
            let at = (p.neutral.xyz - scene.eyes_middle.xyz) / scene.eyes_middle.w;
            // Hairs thinner than a pixel are their mean.
            let hair = mix(strands(at), 0.5, smoothstep(0.012, 0.036, pixel));
            f.albedo *= 0.65 + 0.75 * hair;
            // Hairs end one before the other towards the border; brows are narrow.
            let in_from_border = p.neutral.w * select(1.0, 2.4, on_brow(at));
            let end = 0.20 + 0.75 * (1.0 - hair);
            alpha = smoothstep(end - 0.18, end + 0.18, in_from_border);
            if alpha < 0.02 {
                discard;
            }
            f.open = 0.4 + 0.6 * min(in_from_border, 1.0);
        }
        if clay && p.material >= MATERIAL_HAIR {
            f.albedo = 0.7 * CLAY * scene.skin.rgb;
        }
        if p.material == MATERIAL_LASHES {
            // Too thin to mirror anything.
            f.roughness = 1.0;
            f.specular = 0.0;
            f.open = 0.4;
            alpha = lash(p.neutral);
        }
    }
    return vec4f(developed(all_lights(f, n, v, p.surface.w * f.open)), alpha);
}
