//! Panics without their words.
//!
//! What a panic says goes to the browser's console at most; that it trapped, the script learns from the
//! browser. The messages, the places in our sources and all that prints them are a tenth of a module.
//! The linker leaves its relocations in the module (`--emit-relocs`), so what only a panic uses can be
//! found: calls of a panic become traps, and so does, with all its data, what can no longer be reached.
//! `wasm-opt` takes away what is left of it. Who looks for a panic builds with `--no-opt`, where the words
//! stay.
//!
//! Source: "WebAssembly Object File Linking" (tool-conventions/Linking.md), symbol table and relocation
//! sections.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use anyhow::{Context as _, Result, ensure};
use wasmparser::{
    ExternalKind, FunctionBody, KnownCustom, Linking, Operator, Parser, Payload, RelocationEntry,
    RelocationType, SymbolFlags, SymbolInfo, TypeRef,
};

use crate::wasm_names::leb;

/// What the linker is asked for, so that [`silenced`] can read who uses what.
pub const LINKER: &str = "-Clink-arg=--emit-relocs";

/// Parts of the (mangled) names of functions that only ever panic.
const PANICS: [&str; 5] = [
    "4core9panicking",
    "4core5slice5index16slice_index_fail",
    "4core3str19slice_error_fail_rt",
    "5alloc7raw_vec12handle_error",
    "5alloc5alloc18handle_alloc_error",
];

/// A body of no locals and nothing but a trap.
const TRAP: [u8; 3] = [0, 0x00, 0x0b];
const UNREACHABLE: u8 = 0x00;
/// The section of a module that holds its functions (WebAssembly 5.5.2).
const CODE: u8 = 10;

/// What refers to something, or is referred to.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Thing {
    /// By its index among all functions.
    Function(u32),
    /// By its place in the table of symbols.
    Data(usize),
}

/// A module as the linker left it.
struct Linked<'a> {
    wasm: &'a [u8],
    /// Functions from elsewhere come first.
    imported: u32,
    bodies: Vec<FunctionBody<'a>>,
    /// The whole code section, with its kind and length.
    code: Range<usize>,
    roots: Vec<Thing>,
    symbols: Vec<SymbolInfo<'a>>,
    /// Where the data symbols lie in the module; none for what is not in the file.
    data: HashMap<usize, Range<usize>>,
    /// Places in the module, ascending, and what is said there.
    uses: Vec<(usize, Thing)>,
    /// Sections that are no longer true afterwards.
    linker_sections: Vec<Range<usize>>,
}

/// The module without the words of its panics, and without the linker's relocations.
///
/// # Errors
/// A module that cannot be read, was linked without [`LINKER`], or has none of the panics that are
/// looked for, which says that their names have changed.
pub fn silenced(wasm: &[u8]) -> Result<Vec<u8>> {
    let linked = Linked::read(wasm)?;
    let mut panics = linked.panics();
    ensure!(!panics.is_empty(), "no function is called as panics are; see PANICS");
    let cuts = linked.cuts(&mut panics)?;
    let kept = linked.reached(&panics, &cuts);
    Ok(linked.written(&panics, &cuts, &kept))
}

impl<'a> Linked<'a> {
    fn read(wasm: &'a [u8]) -> Result<Self> {
        let mut linked = Self {
            wasm,
            imported: 0,
            bodies: Vec::new(),
            code: 0..0,
            roots: Vec::new(),
            symbols: Vec::new(),
            data: HashMap::new(),
            uses: Vec::new(),
            linker_sections: Vec::new(),
        };
        let (mut code_starts, mut data_starts, mut segments) = (0, 0, Vec::new());
        let mut relocations: Vec<(&str, Vec<RelocationEntry>)> = Vec::new();
        let mut end = 8;
        for payload in Parser::new(0).parse_all(wasm) {
            let payload = payload.context("a module that cannot be read")?;
            if let Some((_, range)) = payload.as_section() {
                let section = end..range.end;
                end = range.end;
                if let Payload::CustomSection(custom) = &payload
                    && (custom.name() == "linking" || custom.name().starts_with("reloc."))
                {
                    linked.linker_sections.push(section.clone());
                }
                if matches!(payload, Payload::CodeSectionStart { .. }) {
                    linked.code = section;
                }
            }
            match payload {
                Payload::ImportSection(imports) => {
                    for import in imports.into_imports() {
                        if matches!(import?.ty, TypeRef::Func(_) | TypeRef::FuncExact(_)) {
                            linked.imported += 1;
                        }
                    }
                }
                Payload::ExportSection(exports) => {
                    for export in exports {
                        let export = export?;
                        if matches!(export.kind, ExternalKind::Func | ExternalKind::FuncExact) {
                            linked.roots.push(Thing::Function(export.index));
                        }
                    }
                }
                Payload::StartSection { func, .. } => linked.roots.push(Thing::Function(func)),
                Payload::CodeSectionStart { range, .. } => code_starts = range.start,
                Payload::CodeSectionEntry(body) => linked.bodies.push(body),
                Payload::DataSection(data) => {
                    data_starts = data.range().start;
                    for segment in data {
                        let segment = segment?;
                        segments.push(segment.range.end - segment.data.len()..segment.range.end);
                    }
                }
                Payload::CustomSection(custom) => match custom.as_known() {
                    KnownCustom::Linking(parts) => {
                        for part in parts {
                            if let Linking::SymbolTable(symbols) = part? {
                                linked.symbols = symbols.into_iter().collect::<Result<_, _>>()?;
                            }
                        }
                    }
                    KnownCustom::Reloc(section) => {
                        let entries = section.entries().into_iter().collect::<Result<_, _>>()?;
                        relocations.push((custom.name(), entries));
                    }
                    _ => {}
                },
                _ => {}
            }
        }
        ensure!(!relocations.is_empty(), "linked without relocations; give rustc {LINKER}");
        for (at, symbol) in linked.symbols.iter().enumerate() {
            if let SymbolInfo::Data { flags, symbol: Some(data), .. } = symbol
                && let Some(segment) = segments.get(data.index as usize)
            {
                let start = segment.start + data.offset as usize;
                let range = start..start + data.size as usize;
                if range.end <= segment.end {
                    linked.data.insert(at, range);
                }
                if flags.intersects(SymbolFlags::EXPORTED | SymbolFlags::NO_STRIP) {
                    linked.roots.push(Thing::Data(at));
                }
            }
        }
        for (section, entries) in relocations {
            let starts = match section {
                "reloc.CODE" => code_starts,
                "reloc.DATA" => data_starts,
                _ => continue,
            };
            for entry in entries {
                if let Some(thing) = linked.thing(&entry) {
                    linked.uses.push((starts + entry.offset as usize, thing));
                }
            }
        }
        linked.uses.sort_by_key(|(place, _)| *place);
        Ok(linked)
    }

    /// What a relocation refers to, if that is a function or data.
    fn thing(&self, entry: &RelocationEntry) -> Option<Thing> {
        let at = entry.index as usize;
        match (self.symbols.get(at)?, entry.ty) {
            (_, RelocationType::TypeIndexLeb) => None,
            (SymbolInfo::Func { index, .. }, _) => Some(Thing::Function(*index)),
            (SymbolInfo::Data { .. }, _) => Some(Thing::Data(at)),
            _ => None,
        }
    }

    /// The functions that only ever panic, by their names.
    fn panics(&self) -> HashSet<u32> {
        let named = self.symbols.iter().filter_map(|symbol| match symbol {
            SymbolInfo::Func { index, name: Some(name), .. } => Some((*index, *name)),
            _ => None,
        });
        let panics = named.filter(|(index, name)| {
            let body = index.checked_sub(self.imported).and_then(|i| self.bodies.get(i as usize));
            let never_returns = body.is_some_and(|body| body.as_bytes().ends_with(&TRAP[1..]));
            never_returns && PANICS.iter().any(|panic| name.contains(panic))
        });
        panics.map(|(index, _)| index).collect()
    }

    /// What becomes one trap: calls of a panic with all that leads to them in a straight line. In it
    /// there is no other call, so all that it does is to write memory that nobody reads after the trap.
    /// A function that begins with such a line is a panic itself.
    fn cuts(&self, panics: &mut HashSet<u32>) -> Result<Vec<Range<usize>>> {
        loop {
            let before = panics.len();
            let mut cuts = Vec::new();
            for (body, index) in self.bodies.iter().zip(self.imported..) {
                if panics.contains(&index) {
                    continue;
                }
                let operators = body.get_operators_reader()?;
                let first = operators.original_position();
                let mut line = first;
                let mut operators = operators.into_iter_with_offsets().peekable();
                while let Some(operator) = operators.next() {
                    let (operator, _) = operator?;
                    let next = match operators.peek() {
                        Some(Ok((_, offset))) => *offset,
                        _ => body.range().end,
                    };
                    match operator {
                        Operator::Call { function_index } if panics.contains(&function_index) => {
                            if line == first {
                                panics.insert(index);
                            }
                            cuts.push(line..next);
                            line = next;
                        }
                        operator if leaves_the_line(&operator) => line = next,
                        _ => {}
                    }
                }
            }
            if panics.len() == before {
                return Ok(cuts);
            }
        }
    }

    /// Everything that is used from outside, by what is left of the functions.
    fn reached(&self, panics: &HashSet<u32>, cuts: &[Range<usize>]) -> HashSet<Thing> {
        let mut reached: HashSet<Thing> = HashSet::new();
        let mut open = self.roots.clone();
        while let Some(thing) = open.pop() {
            if !reached.insert(thing) {
                continue;
            }
            let range = match thing {
                Thing::Function(index) if panics.contains(&index) => continue,
                Thing::Function(index) => index
                    .checked_sub(self.imported)
                    .and_then(|i| self.bodies.get(i as usize))
                    .map(FunctionBody::range),
                Thing::Data(at) => self.data.get(&at).cloned(),
            };
            let Some(range) = range else { continue };
            let from = self.uses.partition_point(|(place, _)| *place < range.start);
            let here = self.uses[from..].iter().take_while(|(place, _)| *place < range.end);
            open.extend(here.filter(|(place, _)| !within(cuts, *place)).map(|(_, thing)| *thing));
        }
        reached
    }

    fn written(
        &self,
        panics: &HashSet<u32>,
        cuts: &[Range<usize>],
        kept: &HashSet<Thing>,
    ) -> Vec<u8> {
        let mut wasm = self.wasm.to_vec();
        for range in self.data.iter().filter(|(at, _)| !kept.contains(&Thing::Data(**at))) {
            wasm[range.1.clone()].fill(0);
        }
        // Symbols may share their bytes.
        for range in self.data.iter().filter(|(at, _)| kept.contains(&Thing::Data(**at))) {
            wasm[range.1.clone()].copy_from_slice(&self.wasm[range.1.clone()]);
        }
        let mut code = Vec::new();
        leb(&mut code, self.bodies.len());
        for (body, index) in self.bodies.iter().zip(self.imported..) {
            if panics.contains(&index) || !kept.contains(&Thing::Function(index)) {
                leb(&mut code, TRAP.len());
                code.extend(TRAP);
                continue;
            }
            let range = body.range();
            let mut out = Vec::with_capacity(range.len());
            let mut at = range.start;
            let from = cuts.partition_point(|cut| cut.start < range.start);
            for cut in cuts[from..].iter().take_while(|cut| cut.start < range.end) {
                out.extend(&self.wasm[at..cut.start]);
                out.push(UNREACHABLE);
                at = cut.end;
            }
            out.extend(&self.wasm[at..range.end]);
            leb(&mut code, out.len());
            code.extend(out);
        }
        let mut section = vec![CODE];
        leb(&mut section, code.len());
        section.extend(code);

        let mut out = Vec::with_capacity(wasm.len());
        let mut at = 0;
        let mut changed = self.linker_sections.clone();
        changed.push(self.code.clone());
        changed.sort_by_key(|range| range.start);
        for range in changed {
            out.extend(&wasm[at..range.start]);
            if range == self.code {
                out.extend(&section);
            }
            at = range.end;
        }
        out.extend(&wasm[at..]);
        out
    }
}

fn within(cuts: &[Range<usize>], place: usize) -> bool {
    let after = cuts.partition_point(|cut| cut.start <= place);
    after > 0 && cuts[after - 1].contains(&place)
}

/// Whether what follows the operator may be reached without it, or somebody else runs meanwhile.
fn leaves_the_line(operator: &Operator<'_>) -> bool {
    use Operator::{
        Block, Br, BrIf, BrTable, Call, CallIndirect, CallRef, Else, End, If, Loop, Return,
        ReturnCall, ReturnCallIndirect, ReturnCallRef, Throw, ThrowRef, TryTable, Unreachable,
    };
    matches!(
        operator,
        Block { .. }
            | Loop { .. }
            | If { .. }
            | Else
            | End
            | Br { .. }
            | BrIf { .. }
            | BrTable { .. }
            | Return
            | Unreachable
            | Call { .. }
            | CallIndirect { .. }
            | CallRef { .. }
            | ReturnCall { .. }
            | ReturnCallIndirect { .. }
            | ReturnCallRef { .. }
            | Throw { .. }
            | ThrowRef
            | TryTable { .. }
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn section(out: &mut Vec<u8>, kind: u8, bytes: &[u8]) {
        out.push(kind);
        leb(out, bytes.len());
        out.extend(bytes);
    }

    fn named(name: &str) -> Vec<u8> {
        [&[name.len() as u8][..], name.as_bytes()].concat()
    }

    /// Five bytes, as the linker leaves room for any number.
    fn padded(number: u8) -> [u8; 5] {
        [number | 128, 128, 128, 128, 0]
    }

    /// `run` panics with words, or keeps what it keeps; `panic` prints digits.
    fn module(panic: &str, relocations: bool) -> Vec<u8> {
        let run = [
            &[0, 0x02, 0x40, 0x20, 0, 0x0d, 0][..], // block, local.get 0, br_if 0
            &[0x41],                                // i32.const words
            &padded(10),
            &[0x10], // call panic
            &padded(1),
            &[0x00, 0x0b, 0x41], // unreachable, end, i32.const kept
            &padded(15),
            &[0x1a, 0x0b],
        ]
        .concat();
        let panics = [&[0, 0x10][..], &padded(2), &[0x00, 0x0b]].concat();
        let print = [&[0, 0x41][..], &padded(19), &[0x1a, 0x0b]].concat();
        let mut code = vec![3];
        let mut starts = Vec::new();
        for body in [&run, &panics, &print] {
            leb(&mut code, body.len());
            starts.push(code.len() as u8);
            code.extend(body);
        }

        let mut wasm = b"\0asm\x01\0\0\0".to_vec();
        section(&mut wasm, 1, b"\x02\x60\x01\x7f\0\x60\0\0");
        section(&mut wasm, 3, &[3, 0, 0, 1]);
        section(&mut wasm, 5, &[1, 0, 1]);
        section(&mut wasm, 7, &[&[1][..], &named("run"), &[0, 0]].concat());
        section(&mut wasm, CODE, &code);
        let data = [&[1, 0, 0x41, 10, 0x0b][..], &named("wordskeptdigits")].concat();
        section(&mut wasm, 11, &data);
        if relocations {
            let function = |index: u8, name: &str| [&[0, 0, index][..], &named(name)].concat();
            let datum = |name: &str, offset: u8| {
                [&[1, 0][..], &named(name), &[0, offset, name.len() as u8]].concat()
            };
            let symbols = [
                vec![6],
                function(0, "run"),
                function(1, panic),
                function(2, "print"),
                datum("words", 0),
                datum("kept", 5),
                datum("digits", 9),
            ]
            .concat();
            let mut linking = [&named("linking")[..], &[2, 8]].concat();
            leb(&mut linking, symbols.len());
            linking.extend(symbols);
            section(&mut wasm, 0, &linking);
            // Kind, offset, symbol, addend for addresses.
            let uses = [
                &named("reloc.CODE")[..],
                &[4, 5],
                &[4, starts[0] + 8, 3, 0],
                &[0, starts[0] + 14, 1],
                &[4, starts[0] + 22, 4, 0],
                &[0, starts[1] + 2, 2],
                &[4, starts[2] + 2, 5, 0],
            ]
            .concat();
            section(&mut wasm, 0, &uses);
        }
        section(&mut wasm, 0, &[&named("mark")[..], b"ok"].concat());
        wasm
    }

    fn bodies(wasm: &[u8]) -> Vec<Vec<u8>> {
        let payloads = Parser::new(0).parse_all(wasm).map(|payload| payload.expect("a module"));
        let bodies = payloads.filter_map(|payload| match payload {
            Payload::CodeSectionEntry(body) => Some(body.as_bytes().to_vec()),
            _ => None,
        });
        bodies.collect()
    }

    #[test]
    fn a_panic_is_a_trap_and_its_words_are_gone() {
        let before = module("_ZN4core9panicking9panic_fmt17h0123456789abcdefE", true);
        let after = silenced(&before).expect("silenced");
        let [run, panic, print] = &bodies(&after)[..] else { unreachable!("three functions") };
        let kept = [&[0x41][..], &padded(15), &[0x1a, 0x0b]].concat();
        let expected = [&[0, 0x02, 0x40, 0x20, 0, 0x0d, 0, 0x00, 0x00, 0x0b][..], &kept].concat();
        assert_eq!(run, &expected);
        assert_eq!((&panic[..], &print[..]), (&TRAP[..], &TRAP[..]));
        let holds = |what: &[u8]| after.windows(what.len()).any(|window| window == what);
        assert!(holds(b"\0\0\0\0\0kept\0\0\0\0\0\0"));
        assert!(!holds(b"linking") && !holds(b"reloc") && holds(b"mark"));
    }

    #[test]
    fn names_that_have_changed_are_said() {
        let error = silenced(&module("panic_elsewhere", true)).expect_err("no panic in it");
        assert!(error.to_string().contains("PANICS"), "{error}");
    }

    #[test]
    fn a_module_without_relocations_is_refused() {
        let error = silenced(&module("_ZN4core9panicking9panic_fmt", false)).expect_err("refused");
        assert!(error.to_string().contains(LINKER), "{error}");
    }
}
