//! The order of a module's functions in which it compresses best.
//!
//! Gzip sees the last 32 KB: functions that resemble each other (one generic function for a dozen types)
//! should stand together. A tool that sorts functions by their names is at hand (`wasm-opt
//! --reorder-functions-by-name`), so each is given its place for a name.

use std::collections::HashMap;

use anyhow::{Context as _, Result};
use wasmparser::{Parser, Payload, TypeRef};

use crate::wasm_names::leb;

/// Bytes that are compared as one.
const GRAM: usize = 6;
/// What more functions than this contain tells nothing about any.
const COMMON: usize = 3000;
/// How far back a function may find what it resembles, bytes.
const WINDOW: usize = 16_000;

/// The module with its functions named by their places (`00000`, `00001`...).
pub fn named_by_place(wasm: &[u8]) -> Result<Vec<u8>> {
    let mut imported = 0u32;
    let mut bodies: Vec<&[u8]> = Vec::new();
    for payload in Parser::new(0).parse_all(wasm) {
        match payload.context("a module that cannot be read")? {
            Payload::ImportSection(imports) => {
                for import in imports.into_imports() {
                    if matches!(import?.ty, TypeRef::Func(_) | TypeRef::FuncExact(_)) {
                        imported += 1;
                    }
                }
            }
            Payload::CodeSectionEntry(body) => bodies.push(&wasm[body.range()]),
            _ => {}
        }
    }
    let mut names = Vec::new();
    leb(&mut names, bodies.len());
    let mut places = vec![0; bodies.len()];
    for (place, index) in order(&bodies).into_iter().enumerate() {
        places[index] = place;
    }
    for (index, place) in places.into_iter().enumerate() {
        leb(&mut names, imported as usize + index);
        let name = format!("{place:05}");
        leb(&mut names, name.len());
        names.extend(name.bytes());
    }
    // A custom section `name` with the subsection 1, the names of functions (WebAssembly 7.4.1).
    let mut section = b"\x04name\x01".to_vec();
    leb(&mut section, names.len());
    section.extend(names);
    let mut named = wasm.to_vec();
    named.push(0);
    leb(&mut named, section.len());
    named.extend(section);
    Ok(named)
}

/// The indices of the functions in their new order: after each, the one of which the largest share is
/// among what stands shortly before.
fn order(bodies: &[&[u8]]) -> Vec<usize> {
    let grams: Vec<Vec<u64>> = bodies.iter().map(|body| grams(body)).collect();
    let mut holders: HashMap<u64, Vec<usize>> = HashMap::new();
    for (index, grams) in grams.iter().enumerate() {
        grams.iter().for_each(|gram| holders.entry(*gram).or_default().push(index));
    }
    holders.retain(|_, of| of.len() > 1 && of.len() < COMMON);

    let mut left: Vec<usize> = (0..bodies.len()).collect();
    let mut shared = vec![0i64; bodies.len()];
    let mut seen: HashMap<u64, usize> = HashMap::new();
    let (mut begin, mut bytes) = (0, 0);
    let mut order: Vec<usize> = Vec::with_capacity(bodies.len());
    while !left.is_empty() {
        // Of those that resemble nothing, the largest.
        let worth = |index: usize| {
            let share = shared[index] as f64 / grams[index].len().max(1) as f64;
            (share, bodies[index].len(), std::cmp::Reverse(index))
        };
        let better = |a: &usize, b: &usize| {
            let (a, b) = (worth(left[*a]), worth(left[*b]));
            a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2)))
        };
        let Some(best) = (0..left.len()).max_by(better) else { break };
        let next = left.swap_remove(best);
        order.push(next);
        bytes += bodies[next].len();
        for gram in &grams[next] {
            let times = seen.entry(*gram).or_default();
            *times += 1;
            if *times == 1 {
                holders.get(gram).into_iter().flatten().for_each(|holder| shared[*holder] += 1);
            }
        }
        while bytes > WINDOW && begin + 1 < order.len() {
            let past = order[begin];
            begin += 1;
            bytes -= bodies[past].len();
            for gram in &grams[past] {
                let times = seen.entry(*gram).or_default();
                *times -= 1;
                if *times == 0 {
                    holders.get(gram).into_iter().flatten().for_each(|holder| shared[*holder] -= 1);
                }
            }
        }
    }
    order
}

/// Every run of [`GRAM`] bytes, once.
fn grams(body: &[u8]) -> Vec<u64> {
    let number = |run: &[u8]| run.iter().fold(0, |number, byte| number << 8 | u64::from(*byte));
    let mut grams: Vec<u64> = body.windows(GRAM).map(number).collect();
    grams.sort_unstable();
    grams.dedup();
    grams
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every function has its place, and those that resemble each other stand together.
    #[test]
    fn like_stands_beside_like() {
        let one = |salt: u8| (0..200u8).map(|i| i.wrapping_mul(7) ^ salt).collect::<Vec<_>>();
        let (a, b) = (one(0), one(85));
        let bodies = [&a[..], &b[..], &a[1..], &b[1..], &a[2..], &[]];
        let found = order(&bodies);
        let mut all = found.clone();
        all.sort_unstable();
        assert_eq!(all, [0, 1, 2, 3, 4, 5]);
        let kinds: Vec<usize> = found.iter().filter(|i| **i < 5).map(|index| index % 2).collect();
        assert!([vec![0, 0, 0, 1, 1], vec![1, 1, 0, 0, 0]].contains(&kinds), "{found:?}");
    }
}
