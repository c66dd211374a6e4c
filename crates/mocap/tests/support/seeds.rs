//! A small valid file of every format, by name of its fuzz target.

use mimique_mocap::{
    C3dOptions, C3dStorage, Capture, LengthUnit, Processor, write_c3d, write_csv, write_trc,
};

fn capture() -> Capture {
    Capture {
        labels: ["brow left", "brow right", "nose"].map(str::to_owned).to_vec(),
        rate_hz: 100.0,
        first_frame: 3,
        unit: LengthUnit::Millimetre,
        positions: (0..60)
            .map(|i| if i == 7 { [f64::NAN; 3] } else { [f64::from(i) * 0.5, 12.0, -99.5] })
            .collect(),
        notes: Vec::new(),
    }
}

/// A small valid file of every format.
pub fn seeds() -> Vec<Vec<u8>> {
    let mut seeds = Vec::new();
    for processor in [Processor::Intel, Processor::Dec, Processor::Mips] {
        for storage in [C3dStorage::Float, C3dStorage::Integer { scale: 0.5 }] {
            seeds.push(write_c3d(&capture(), &C3dOptions { processor, storage }).unwrap());
        }
    }
    seeds.push(write_csv(&capture()).unwrap().into_bytes());
    seeds.push(write_trc(&capture(), "a.trc").unwrap().into_bytes());
    let texts = [
        "NO_OF_FRAMES\t2\nFREQUENCY\t200\nDATA_INCLUDED\t3D\nEVENT\ta\t1\t0.5\nMARKER_NAMES\ta\tb\n\
         1\t0\t1\t2\t3\t4\t5\t6\n2\t0.005\t1\t2\t3\t\t\t\n",
        "1\t2\t3\t4\t5\t6\n1\t2\t3\t4\t5\t6\n",
        "Format Version,1.23,Capture Frame Rate,120,Length Units,Meters\n\n,Type,Marker,Marker,Marker\n\
         ,Name,a,a,a\n,ID,1,1,1\n,,Position,Position,Position\nFrame,Time,X,Y,Z\n0,0,1,2,3\n1,0.1,,,\n",
        "Trajectories\n100\n,,a,,,b,,\nFrame,Sub Frame,X,Y,Z,X,Y,Z\n,,mm,mm,mm,mm,mm,mm\n\
         1,0,1,2,3,4,5,6\n2,0,1,2,3\n",
        "frame,time,marker,x,y,z\n0,0,a,1,2,3\n0,0,b,1,2,3\n1,0.1,a,4,5,6\n",
        "Timecode,BlendShapeCount,EyeBlinkLeft,JawOpen\n01:00:00:01.000,2,0.1,0.2\n01:00:00:04.000,2,1,0\n",
        "HIERARCHY\nROOT Hips\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n\
         JOINT Head\n{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\n}\n\
         MOTION\nFrames: 2\nFrame Time: 0.01\n0 0 0 0 0 0 0 0 90\n1 0 0 0 0 0 0 0 0\n",
    ];
    seeds.extend(texts.iter().map(|t| t.as_bytes().to_vec()));
    seeds
}
