//! Landmarks and regions.
use mimique_layout::{Candidates, Face, Where, Excluded, FacePart};
use mimique_stimulus::AvatarSkin;

#[test]
fn look() {
    for file in ["/work/shared/data/lsts/avatar_skin.glb", "/tmp/ex/sample/head.glb", "/work/shared/data/ict-facekit/ict-facekit.glb"] {
        let t = std::time::Instant::now();
        let avatar = mimique_avatar_files::read_avatar(std::path::Path::new(file)).unwrap().avatar;
        let skin = AvatarSkin::of(&avatar).unwrap();
        eprintln!("{file} read {:?}", t.elapsed());
        let face = Face::of(&skin).unwrap();
        eprintln!("{:#?}", face.landmarks);
        eprintln!("face {:?}", t.elapsed());
        for e in Excluded::ALL { eprintln!("{e} {}", e.mask(&face).iter().filter(|x| **x).count()); }
        let c = Candidates::of(&face, &Where::default());
        eprintln!("{:?} {:?}", c.counts, t.elapsed());
        for p in FacePart::ALL { eprintln!("{} {}", p.name(), c.vertices.iter().filter(|v| face.part(**v)==p).count()); }
        let mut out = String::new();
        let masks: Vec<Vec<bool>> = Excluded::ALL.iter().map(|e| e.mask(&face)).collect();
        for v in 0..skin.mesh.positions.len() {
            let p = face.place(v);
            let m: Vec<String> = masks.iter().map(|m| (m[v] as u8).to_string()).collect();
            let ok = c.vertices.binary_search(&v).is_ok() as u8;
            out.push_str(&format!("{} {} {} {} {} {:?}\n", p.x, p.y, p.z, m.join(" "), ok, face.part(v)));
        }
        let name = std::path::Path::new(file).file_stem().unwrap().to_str().unwrap();
        std::fs::write(format!("/tmp/ex/{name}.regions"), out).unwrap();
    }
}
