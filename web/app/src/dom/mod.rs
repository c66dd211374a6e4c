//! A virtual DOM and its diff: what a page shows is described anew with every change, and only what
//! differs is touched. Focus, carets and running videos stay.
//!
//! What happens to an element comes out as an [`Act`], which goes to the one [`Dispatch`] of the mount:
//! no page holds the session. Nothing has type parameters but at the border: one copy of the code serves
//! every page. (A framework costs 122 KB more, `docs/measured/page-speed.md`.)

mod mount;

use std::rc::Rc;

use wasm_bindgen::JsCast as _;
use web_sys::{Event, HtmlInputElement, HtmlTextAreaElement, KeyboardEvent, Node};

use crate::act::Act;
use crate::browser::clock::time_of;

pub use mount::Mount;

/// What a field holds when something happens to it.
pub struct FieldEvent {
    /// Value of the field; of a key press, the key, or nothing where it is a shortcut.
    pub value: String,
    /// Whether a check box is checked.
    pub checked: bool,
    /// When it happened, page clock.
    pub at_ms: f64,
}

impl FieldEvent {
    /// The number that the field holds; none where it holds none.
    pub fn number(&self) -> Option<f64> {
        self.value.trim().parse().ok().filter(|number: &f64| number.is_finite())
    }

    fn of(event: &Event) -> Self {
        let at_ms = time_of(event);
        if let Some(press) = event.dyn_ref::<KeyboardEvent>() {
            let is_shortcut = press.ctrl_key() || press.alt_key() || press.meta_key();
            let value = if is_shortcut { String::new() } else { press.key() };
            return Self { value, checked: false, at_ms };
        }
        let Some(target) = event.target() else {
            return Self { value: String::new(), checked: false, at_ms };
        };
        match target.dyn_into::<HtmlInputElement>() {
            Ok(input) => Self { value: input.value(), checked: input.checked(), at_ms },
            Err(other) => {
                let area = other.dyn_ref::<HtmlTextAreaElement>();
                let value = area.map(HtmlTextAreaElement::value).unwrap_or_default();
                Self { value, checked: false, at_ms }
            }
        }
    }
}

/// Where acts go.
pub type Dispatch = Rc<dyn Fn(Act)>;

type Handler = Rc<dyn Fn(FieldEvent) -> Option<Act>>;
type Hook = Box<dyn FnOnce(&Node)>;

/// What of an element a value is written to.
#[derive(Clone, Copy, PartialEq)]
enum Target {
    Attribute(&'static str),
    Style(&'static str),
    Value,
    Checked,
}

/// An element as it should stand.
pub struct Element(Box<Parts>);

#[derive(Default)]
struct Parts {
    /// Empty for a piece of text.
    tag: &'static str,
    key: String,
    text: String,
    settings: Vec<(Target, String)>,
    on: Vec<(&'static str, Handler)>,
    children: Vec<Element>,
    mounted: Option<(Hook, fn())>,
}

/// An element of a class ("" for none).
#[inline(never)]
pub fn el(tag: &'static str, class: &str) -> Element {
    let element = Element(Box::new(Parts { tag, ..Parts::default() }));
    if class.is_empty() { element } else { element.set("class", class) }
}

/// An element that holds a text alone.
#[inline(never)]
pub fn words(tag: &'static str, class: &str, text: &str) -> Element {
    el(tag, class).text(text)
}

impl Element {
    /// An attribute.
    pub fn set(self, name: &'static str, value: &str) -> Self {
        self.write(Target::Attribute(name), value)
    }

    /// A custom property of its style, such as `--stage-width`.
    pub fn style(self, name: &'static str, value: &str) -> Self {
        self.write(Target::Style(name), value)
    }

    /// What a field holds.
    pub fn value(self, value: &str) -> Self {
        self.write(Target::Value, value)
    }

    /// Whether a field is checked.
    pub fn checked(self, on: bool) -> Self {
        self.write(Target::Checked, if on { "true" } else { "" })
    }

    #[inline(never)]
    fn write(mut self, target: Target, value: &str) -> Self {
        self.0.settings.push((target, value.to_owned()));
        self
    }

    /// An attribute that may be missing.
    #[inline(never)]
    pub fn maybe(self, name: &'static str, value: Option<&str>) -> Self {
        match value {
            Some(value) => self.set(name, value),
            None => self,
        }
    }

    /// An attribute that is there or not.
    #[inline(never)]
    pub fn flag(self, name: &'static str, on: bool) -> Self {
        if !on {
            return self;
        }
        let value = if name.starts_with("aria-") { "true" } else { "" };
        self.set(name, value)
    }

    /// What tells it from its neighbours: another key is another element.
    #[inline(never)]
    pub fn key(mut self, key: &str) -> Self {
        key.clone_into(&mut self.0.key);
        self
    }

    /// A piece of text inside.
    #[inline(never)]
    pub fn text(mut self, text: &str) -> Self {
        let text = text.to_owned();
        self.0.children.push(Element(Box::new(Parts { text, ..Parts::default() })));
        self
    }

    /// An element inside.
    #[inline(never)]
    pub fn with(mut self, child: Element) -> Self {
        self.0.children.push(child);
        self
    }

    /// An element inside that may be missing.
    #[inline(never)]
    pub fn option(self, child: Option<Element>) -> Self {
        match child {
            Some(child) => self.with(child),
            None => self,
        }
    }

    /// Elements inside.
    #[inline(never)]
    pub fn all(mut self, mut children: Vec<Element>) -> Self {
        self.0.children.append(&mut children);
        self
    }

    /// A paragraph inside for each text.
    #[inline(never)]
    pub fn paragraphs(mut self, texts: &[String]) -> Self {
        for text in texts {
            self = self.with(words("p", "", text));
        }
        self
    }

    /// What is asked for when something happens to it.
    pub fn on<A: Into<Act>>(
        self,
        name: &'static str,
        handler: impl Fn(FieldEvent) -> A + 'static,
    ) -> Self {
        self.handle(name, Rc::new(move |event| Some(handler(event).into())))
    }

    /// What is done, or perhaps asked for, when something happens to it.
    pub fn handles(
        self,
        name: &'static str,
        handler: impl Fn(FieldEvent) -> Option<Act> + 'static,
    ) -> Self {
        self.handle(name, Rc::new(handler))
    }

    #[inline(never)]
    fn handle(mut self, name: &'static str, handler: Handler) -> Self {
        self.0.on.push((name, handler));
        self
    }

    /// What is done with the node once it stands on the page, and once it has gone.
    pub fn mounted(mut self, stands: impl FnOnce(&Node) + 'static, gone: fn()) -> Self {
        self.0.mounted = Some((Box::new(stands), gone));
        self
    }
}
