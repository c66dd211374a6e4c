// Passes 2 and 4: the head seen by the key light (depth only), and the picture.
@group(0) @binding(0) var<uniform> scene: Scene;
@group(0) @binding(1) var positions: texture_2d<f32>;
@group(0) @binding(2) var surfaces: texture_2d<f32>;
@group(0) @binding(3) var neutral: texture_2d<f32>;

// Layout: `layouts.rs`, `Material`.
const MATERIAL_SKIN: u32 = 0u;
const MATERIAL_PAINTED_SKIN: u32 = 1u;
const MATERIAL_TEETH: u32 = 2u;
const MATERIAL_TONGUE: u32 = 3u;
const MATERIAL_SOCKET: u32 = 4u;
const MATERIAL_HAIR: u32 = 5u;
const MATERIAL_WET: u32 = 6u;
const MATERIAL_CLOTH: u32 = 7u;
const MATERIAL_EYE: u32 = 8u;

const PI: f32 = 3.14159265;
const KEY_LIGHT: vec3f = vec3f(2.05, 1.93, 1.78);
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
    // Neutral position; distance from the rim of the mouth.
    @location(2) neutral: vec4f,
    @location(3) colour: vec3f,
    @location(4) @interpolate(flat) material: u32,
}

@vertex
fn project(@builtin(vertex_index) index: u32, @location(0) colour: vec4f) -> Point {
    let texel = vertex_texel(index);
    let position = textureLoad(positions, texel, 0);
    var out: Point;
    out.clip = scene.clip_from_world * position;
    out.position = position.xyz;
    out.surface = textureLoad(surfaces, texel, 0);
    out.neutral = textureLoad(neutral, texel, 0);
    out.colour = colour.rgb * colour.rgb;
    out.material = u32(colour.a * 255.0 + 0.5);
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

fn one_light(f: Finish, n: vec3f, v: vec3f, l: vec3f, light: vec3f, visible: vec3f) -> vec3f {
    let ndl = dot(n, l);
    let shine = gloss(n, v, l, f.roughness, f.specular) * max(ndl, 0.0) * PI;
    return light * visible * (f.albedo * wrapped(ndl, f.wrap) + vec3f(shine));
}

fn all_lights(f: Finish, n: vec3f, v: vec3f, key_visible: f32) -> vec3f {
    // Where the surface turns from the light the wrapped falloff shades it already.
    let toward = smoothstep(-0.05, 0.30, dot(n, KEY));
    let shade = mix(1.0, key_visible, toward);
    // Blood scatters red into a shadow's edge.
    let key = pow(vec3f(shade), vec3f(1.0) / (1.0 + 1.6 * f.wrap));
    var sum = one_light(f, n, v, KEY, KEY_LIGHT, key);
    sum += one_light(f, n, v, FILL, FILL_LIGHT, vec3f(f.open));
    let edge = 1.0 - max(dot(n, v), 0.0);
    let rim = vec3f(edge * edge * f.open);
    sum += one_light(f, n, v, RIM_LEFT, RIM_LIGHT, rim);
    sum += one_light(f, n, v, RIM_RIGHT, RIM_LIGHT, rim);
    let around = mix(GROUND, SKY, n.y * 0.5 + 0.5) * f.open;
    let e2 = edge * edge;
    let mirror = f.specular + (1.0 - f.roughness) * (1.0 - f.specular) * e2 * e2 * edge;
    return sum + around * (f.albedo + mirror * 0.6);
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

fn painted(base: vec3f, at: vec4f) -> vec3f {
    let unit = scene.eyes_middle.w;
    let p = (at.xyz - scene.eyes_middle.xyz) / unit;
    let side = abs(p.x);
    let front = smoothstep(-0.5, 0.0, p.z);
    // Blood under cheeks, nose and chin.
    let cheek = exp(-(dot(vec2f(side - 0.62, p.y + 0.62), vec2f(side - 0.62, p.y + 0.62))) * 9.0);
    let nose = exp(-dot(vec2f(side, p.y + 0.70), vec2f(side, p.y + 0.70)) * 22.0);
    var colour = base * mix(vec3f(1.0), vec3f(1.04, 0.86, 0.84), (0.75 * cheek + 0.55 * nose) * front);
    colour *= 0.96 + 0.08 * noise(p.xy * 26.0);
    // Lips: a band about the rim of the mouth, wider in the middle.
    let across = clamp(1.0 - side * side * 5.0, 0.25, 1.0);
    let lip = 1.0 - smoothstep(0.085 * across, 0.135 * across, at.w);
    colour = mix(colour, base * vec3f(0.80, 0.50, 0.50), 0.80 * lip);
    // Brows: an arch over each eye, thinner outwards, of hairs that lean outwards.
    let along = (side - 0.17) / 0.66;
    let arch = 0.335 + 0.13 * sin(clamp(along * 1.25, 0.0, 1.25) * 1.9) - 0.10 * along * along;
    let thick = mix(0.075, 0.028, clamp(along, 0.0, 1.0));
    let off = (p.y - arch) / thick;
    let hairs = noise(vec2f(side * 46.0 - p.y * 30.0, p.y * 34.0 + side * 22.0));
    let body = 1.0 - smoothstep(0.35, 1.05 + 0.35 * (hairs - 0.5), abs(off));
    let ends = smoothstep(-0.04, 0.10, along) * (1.0 - smoothstep(0.86, 1.02, along));
    let brow = body * ends * (0.62 + 0.38 * hairs) * front * scene.brows.w;
    return mix(colour, scene.brows.rgb, clamp(brow, 0.0, 0.94));
}

// ---- eyes ----

fn eye(f_in: Finish, n: vec3f, v: vec3f, p: Point, index: u32) -> vec3f {
    let gaze = scene.gaze[index];
    let arm = p.position - vec3f(gaze.rows[0].w, gaze.rows[1].w, gaze.rows[2].w);
    let local = vec3f(dot(gaze.rows[0].xyz, arm), dot(gaze.rows[1].xyz, arm), dot(gaze.rows[2].xyz, arm));
    let local_v = normalize(vec3f(dot(gaze.rows[0].xyz, v), dot(gaze.rows[1].xyz, v), dot(gaze.rows[2].xyz, v)));
    let direction = normalize(local);
    // The iris is a disc behind the cornea: follow the refracted ray down to it.
    let inward = refract(-local_v, direction, 1.0 / 1.336);
    let depth = (direction.z - 0.80) / max(-inward.z, 0.2);
    let on_iris = direction.xy + inward.xy * max(depth, 0.0);
    let r = length(on_iris);
    let IRIS = 0.46;
    let PUPIL = 0.175;
    let angle = atan2(on_iris.y, on_iris.x);
    let fibres = noise(vec2f(angle * 14.0, r * 9.0)) * 0.6 + noise(vec2f(angle * 37.0 + 9.0, r * 17.0)) * 0.4;
    let s = r / IRIS;
    var iris = scene.iris.rgb * (0.55 + 0.95 * fibres) * mix(1.5, 0.85, smoothstep(0.4, 0.95, s));
    iris = mix(iris, scene.iris.rgb * vec3f(1.9, 1.45, 0.8), 0.45 * (1.0 - smoothstep(0.42, 0.62, s)));
    iris *= 1.0 - 0.82 * smoothstep(0.80, 1.0, s);
    iris *= smoothstep(PUPIL, PUPIL + 0.035, r);
    // Light that entered the cornea from above gathers on the iris' lower half.
    iris *= 1.0 + 0.55 * clamp(-on_iris.y / IRIS, -0.6, 1.0);
    let bare = p.colour * mix(vec3f(0.84, 0.79, 0.76), vec3f(0.74, 0.48, 0.43), smoothstep(0.62, 1.05, length(direction.xy)));
    let white = 1.0 - smoothstep(-0.030, 0.030, IRIS - r);
    var f = f_in;
    f.albedo = mix(iris, bare, white);
    f.wrap = vec3f(0.30, 0.22, 0.20);
    f.specular = 0.0;
    f.roughness = 0.5;
    // The lids stand before the ball and take light from its upper and outer parts.
    let lids = 1.0 - 0.55 * smoothstep(0.05, 0.62, local.y + 0.10 * abs(local.x)) - 0.40 * smoothstep(0.45, 0.95, length(local.xy));
    f.open = clamp(lids, 0.15, 1.0);
    var colour = all_lights(f, n, v, p.surface.w) * mix(1.0, f.open, 0.5);
    // The wet cornea mirrors a soft box (the key) and a dim window (the fill).
    let curved = normalize(n + 0.35 * (1.0 - white) * (n - vec3f(gaze.rows[2].xyz)));
    let mirror = reflect(-v, curved);
    let box = smoothstep(0.955, 0.978, dot(mirror, KEY)) * mix(0.35, 1.0, p.surface.w);
    let window = smoothstep(0.90, 0.97, dot(mirror, FILL));
    let grazing = 1.0 - max(dot(n, v), 0.0);
    let fresnel = 0.025 + 0.5 * pow(grazing, 5.0);
    colour += (box * 34.0 * KEY_LIGHT * 0.5 + window * 2.2 * FILL_LIGHT + 0.7 * mix(GROUND, SKY, mirror.y * 0.5 + 0.5) * f.open) * fresnel;
    return colour;
}

// ---- picture ----

// A film's response: linear in the shadows, a long shoulder (Hable 2010), scaled so that 1 stays
// under white.
fn film(x: vec3f) -> vec3f {
    return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.50) + 0.06) - 0.0666667;
}

fn developed(light: vec3f) -> vec3f {
    let white = film(vec3f(6.0));
    return clamp(film(light * scene.iris.w * 2.0) / white, vec3f(0.0), vec3f(1.0));
}

@fragment
fn shade(p: Point, @builtin(front_facing) front: bool) -> @location(0) vec4f {
    let v = normalize(scene.camera.xyz - p.position);
    var n = normalize(p.surface.xyz);
    var f: Finish;
    f.albedo = p.colour;
    f.roughness = 0.55;
    f.specular = 0.030;
    f.wrap = vec3f(0.10);
    f.open = 1.0;
    var alpha = 1.0;
    // How far behind the lips, and so how dark.
    let behind = clamp((scene.mouth.z - p.position.z) / scene.mouth.w, 0.0, 1.6);
    if p.material >= MATERIAL_EYE {
        return vec4f(developed(eye(f, n, v, p, p.material - MATERIAL_EYE)), 1.0);
    }
    if p.material <= MATERIAL_PAINTED_SKIN {
        var albedo = p.colour;
        if p.material == MATERIAL_PAINTED_SKIN {
            albedo = painted(albedo, p.neutral);
        }
        f.albedo = albedo * scene.skin.rgb;
        f.roughness = scene.skin.w;
        f.specular = 0.028;
        f.wrap = vec3f(0.42, 0.20, 0.14);
    } else {
        if !front {
            n = -n;
        }
        if p.material <= MATERIAL_SOCKET {
            f.open = exp(-2.6 * behind);
            f.wrap = vec3f(0.25, 0.12, 0.10);
            f.roughness = select(0.34, 0.28, p.material == MATERIAL_TEETH);
            f.albedo *= select(0.55, 0.80, p.material == MATERIAL_TEETH);
        }
        if p.material == MATERIAL_HAIR {
            f.roughness = 0.62;
        }
        if p.material == MATERIAL_WET {
            f.roughness = 0.18;
            alpha = 0.25;
        }
    }
    return vec4f(developed(all_lights(f, n, v, p.surface.w * f.open)), alpha);
}
