//! What is known of each method.

use super::definition::{Definition, Needs};
use super::names::Method;
use crate::parameters::group::Group;
use crate::parameters::table::PARAMETERS;

macro_rules! definitions {
    ($($variant:ident $name:literal $file:ident::$definition:ident)+) => {
        impl Method {
            /// What the method minimises, what it needs, and how it is set up.
            pub(crate) fn definition(self) -> &'static Definition {
                match self {
                    $(Method::$variant => &super::$file::$definition,)+
                }
            }
        }
    };
}

every_method! { definitions }

impl Method {
    /// What it minimises, in a few words.
    pub fn summary(self) -> &'static str {
        self.definition().summary
    }

    /// What it is set up with.
    pub fn needs(self) -> Needs {
        self.definition().needs
    }

    /// Whether it uses the parameters of a group.
    pub fn uses(self, group: Group) -> bool {
        match group {
            Group::Timing => true,
            Group::Blend => {
                self.needs() == Needs::Shapes
                    && !self.definition().uses.contains(&Group::Association)
            }
            _ => self.definition().uses.contains(&group),
        }
    }

    /// Whether the weights of a frame depend on other frames of the take: on the one before, or on those
    /// of a window.
    pub fn uses_other_frames(self) -> bool {
        self.uses(Group::Audio2Face) || self.uses(Group::Smoothness)
    }

    /// The keys of the parameters that it uses, in the order of the table.
    pub fn parameters(self) -> Vec<&'static str> {
        let rows = PARAMETERS.iter().filter(|row| self.uses(row.about.group));
        rows.map(|row| row.key).collect()
    }
}
