//! What must hold of the readers of activities whatever they are given; used by tests and the fuzz target.

use mimique_mocap::{ActivityColumn, read_activity_bytes};

/// An activity that comes out is whole and not larger than its file; an error has place and remedy.
pub fn read_activity_anyhow(bytes: &[u8]) {
    match read_activity_bytes(bytes) {
        Ok(activity) => {
            let samples = activity.time_s.len();
            assert!(samples > 0 && samples <= bytes.len() && activity.time_s[0] == 0.0);
            assert!(activity.time_s.windows(2).all(|pair| pair[1] > pair[0]));
            let mut columns = 0;
            for column in ActivityColumn::ALL {
                let Some(values) = activity.column(column) else { continue };
                columns += 1;
                let [least, most] = column.range();
                assert_eq!(values.len(), samples);
                assert!(values.iter().all(|v| v.is_nan() || (least..=most).contains(v)));
                assert!(values.iter().any(|v| !v.is_nan()));
            }
            assert!(columns > 0);
        }
        Err(error) => {
            let text = error.to_string();
            assert!(text.contains(": ") && text.contains("; "), "{text}");
        }
    }
}
