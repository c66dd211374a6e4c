//! What is wrong with a method's parameters: all of it, as codes with values.

use crate::parameters::group::Group;
use crate::parameters::problem::{SpecError, SpecFault};
use crate::parameters::table::MethodSpec;

impl MethodSpec {
    /// The first problem, if there is one.
    ///
    /// # Errors
    /// The first of [`MethodSpec::problems`].
    pub fn validate(&self) -> Result<(), SpecError> {
        self.problems().into_iter().next().map_or(Ok(()), Err)
    }

    /// Every problem: parameters that the method does not use, and values out of range.
    ///
    /// Whether the names in `locked`, `importance` and `bounds` exist is known only with an avatar
    /// and a marker map: `Fit::new` checks them.
    pub fn problems(&self) -> Vec<SpecError> {
        let mut found = Vec::new();
        for (row, field) in self.fields() {
            let Some(value) = field.json() else { continue };
            if !self.uses(row.about.group) {
                found.push(SpecError::of(row.key, SpecFault::NotUsed { method: self.method }));
                continue;
            }
            field.check(&row.limits(), &mut |entry, fault| {
                let entry = entry.map(str::to_owned);
                found.push(SpecError { field: row.key.to_owned(), entry, fault });
            });
            if let Some(effect) = row.about.effect
                && !(effect.when)(self)
            {
                let fault =
                    SpecFault::NoEffect { value: value.to_string(), because: effect.because };
                found.push(SpecError::of(row.key, fault));
            }
        }
        if self.uses(Group::ThinShell) && self.k_s() == 0.0 && self.k_b() == 0.0 {
            found.push(SpecError::of("kS", SpecFault::NoThinShell));
        }
        if let Some(second) = self.blend_with
            && (second == self.method || !second.uses(Group::Blend))
        {
            let fault = SpecFault::NotBlended { method: self.method, second };
            found.push(SpecError::of("blendWith", fault));
        }
        self.check_importance(&mut found);
        self.check_locked(&mut found);
        found
    }

    /// A marker that is met exactly cannot be met more exactly than another.
    fn check_importance(&self, found: &mut Vec<SpecError>) {
        if !self.method.uses(Group::Surface) || self.stiffness() != 0.0 {
            return;
        }
        for (label, &importance) in &self.importance {
            if importance > 0.0 && importance != 1.0 {
                found.push(SpecError {
                    field: "importance".to_owned(),
                    entry: Some(label.clone()),
                    fault: SpecFault::MetExactly { importance },
                });
            }
        }
    }

    /// A locked shape is named once and has no bounds.
    fn check_locked(&self, found: &mut Vec<SpecError>) {
        for (index, name) in self.locked.iter().enumerate() {
            let mut add = |fault| {
                let (field, entry) = ("locked".to_owned(), Some(index.to_string()));
                found.push(SpecError { field, entry, fault });
            };
            let shape = name.clone();
            if self.locked[..index].contains(name) {
                add(SpecFault::LockedTwice { shape: shape.clone() });
            }
            if self.bounds.contains_key(name) {
                add(SpecFault::LockedAndBounded { shape });
            }
        }
    }
}
