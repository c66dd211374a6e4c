//! The methods by name.

use std::fmt;

use serde::{Deserialize, Serialize};

macro_rules! names {
    ($($variant:ident $name:literal $file:ident::$definition:ident)+) => {
        /// The methods; each is described in the file that defines it.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
        pub enum Method {
            $(
                #[doc = concat!("`", $name, "`.")]
                #[serde(rename = $name)]
                $variant,
            )+
        }

        impl Method {
            /// Every method, in the order in which they are listed.
            pub const ALL: [Method; [$($name),+].len()] = [$(Method::$variant),+];

            /// Their names, in the same order.
            pub const NAMES: &'static [&'static str] = &[$($name),+];

            /// The name in study files and on the command line.
            pub fn name(self) -> &'static str {
                match self {
                    $(Method::$variant => $name,)+
                }
            }
        }
    };
}

every_method! { names }

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
