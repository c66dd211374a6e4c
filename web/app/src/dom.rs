//! A virtual DOM and its diff: what a page shows is described anew with every change, and only what
//! differs is touched. Focus, carets and running videos stay.
//!
//! What happens to an element comes out as an [`Act`], which goes to the one [`Dispatch`] of the mount:
//! no page holds the session. Nothing has type parameters but at the border: one copy of the code serves
//! every page. (A framework costs 122 KB more, `docs/measured/page-speed.md`.)

use std::cell::RefCell;
use std::rc::Rc;

use gloo_events::{EventListener, EventListenerOptions};
use gloo_utils::document;
use wasm_bindgen::JsCast as _;
use web_sys::{Event, HtmlElement, HtmlInputElement, HtmlTextAreaElement, KeyboardEvent, Node};

use crate::act::Act;

/// What a field holds when something happens to it.
pub struct FieldEvent {
    /// Value of the field; of a key press, the key, or nothing where it is a shortcut.
    pub value: String,
    /// Whether a check box is checked.
    pub checked: bool,
}

impl FieldEvent {
    /// The number that the field holds; none where it holds none.
    pub fn number(&self) -> Option<f64> {
        self.value.trim().parse().ok().filter(|number: &f64| number.is_finite())
    }

    fn of(event: &Event) -> Self {
        if let Some(press) = event.dyn_ref::<KeyboardEvent>() {
            let is_shortcut = press.ctrl_key() || press.alt_key() || press.meta_key();
            let value = if is_shortcut { String::new() } else { press.key() };
            return Self { value, checked: false };
        }
        let Some(target) = event.target() else {
            return Self { value: String::new(), checked: false };
        };
        match target.dyn_into::<HtmlInputElement>() {
            Ok(input) => Self { value: input.value(), checked: input.checked() },
            Err(other) => {
                let area = other.dyn_ref::<HtmlTextAreaElement>();
                let value = area.map(HtmlTextAreaElement::value).unwrap_or_default();
                Self { value, checked: false }
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

/// An element that stands on the page.
struct Mounted {
    node: Node,
    tag: &'static str,
    key: String,
    text: String,
    settings: Vec<(Target, String)>,
    listeners: Vec<Listener>,
    children: Vec<Mounted>,
    gone: Option<fn()>,
}

struct Listener {
    name: &'static str,
    handler: Rc<RefCell<Handler>>,
    _listener: EventListener,
}

/// A place on the page and what stands there.
pub struct Mount {
    node: Node,
    children: Vec<Mounted>,
    dispatch: Dispatch,
}

impl Mount {
    /// A place whose elements send their acts to `dispatch`.
    pub fn new(node: Node, dispatch: Dispatch) -> Self {
        Self { node, children: Vec::new(), dispatch }
    }

    /// Makes what stands there what it should be.
    pub fn show(&mut self, elements: Vec<Element>) {
        let mut diff = Diff { dispatch: &self.dispatch, hooks: Vec::new() };
        diff.children(&self.node, &mut self.children, elements);
        for (hook, node) in diff.hooks {
            hook(&node);
        }
    }
}

/// One pass over the elements of a place.
struct Diff<'a> {
    dispatch: &'a Dispatch,
    /// What is done once everything stands.
    hooks: Vec<(Hook, Node)>,
}

impl Diff<'_> {
    fn create(&mut self, Element(parts): Element) -> Mounted {
        let Parts { tag, key, text, settings, on, children, mounted } = *parts;
        let node = node(tag, &text);
        for (target, value) in &settings {
            target.write(&node, Some(value));
        }
        let children: Vec<Mounted> = children
            .into_iter()
            .map(|child| {
                let child = self.create(child);
                insert(&node, &child.node, None);
                child
            })
            .collect();
        let listeners =
            on.into_iter().map(|(name, handler)| self.listener(&node, name, handler)).collect();
        let gone = mounted.map(|(stands, gone)| {
            self.hooks.push((stands, node.clone()));
            gone
        });
        Mounted { node, tag, key, text, settings, listeners, children, gone }
    }

    fn listener(&self, node: &Node, name: &'static str, handler: Handler) -> Listener {
        let handler = Rc::new(RefCell::new(handler));
        let (now, dispatch) = (Rc::clone(&handler), Rc::clone(self.dispatch));
        let options = EventListenerOptions::enable_prevent_default();
        let listener = EventListener::new_with_options(node, name, options, move |event| {
            if name == "submit" {
                event.prevent_default();
            }
            let handler = Rc::clone(&*now.borrow());
            if let Some(act) = handler(FieldEvent::of(event)) {
                dispatch(act);
            }
        });
        Listener { name, handler, _listener: listener }
    }

    fn update(&mut self, old: &mut Mounted, Element(parts): Element) {
        let parts = *parts;
        if old.tag.is_empty() {
            if old.text != parts.text {
                old.node.set_text_content(Some(&parts.text));
                old.text = parts.text;
            }
            return;
        }
        for (target, value) in &parts.settings {
            let before = old.settings.iter().find(|(each, _)| each == target);
            if before.is_none_or(|(_, before)| before != value) {
                target.write(&old.node, Some(value));
            }
        }
        for (target, _) in &old.settings {
            if !parts.settings.iter().any(|(each, _)| each == target) {
                target.write(&old.node, None);
            }
        }
        old.settings = parts.settings;
        for (name, handler) in parts.on {
            match old.listeners.iter().find(|each| each.name == name) {
                Some(listener) => *listener.handler.borrow_mut() = handler,
                None => old.listeners.push(self.listener(&old.node, name, handler)),
            }
        }
        self.children(&old.node, &mut old.children, parts.children);
    }

    /// Elements keep their order, so that one pass finds those that stay.
    fn children(&mut self, node: &Node, old: &mut Vec<Mounted>, new: Vec<Element>) {
        let mut rest = std::mem::take(old);
        // The next one is the last.
        rest.reverse();
        for element in new {
            let same = |each: &Mounted| each.tag == element.0.tag && each.key == element.0.key;
            if let Some(at) = rest.iter().rposition(same) {
                for gone in rest.drain(at + 1..) {
                    remove(&gone);
                }
                if let Some(mut stays) = rest.pop() {
                    self.update(&mut stays, element);
                    old.push(stays);
                }
            } else {
                let new = self.create(element);
                insert(node, &new.node, rest.last().map(|next| &next.node));
                old.push(new);
            }
        }
        for gone in &rest {
            remove(gone);
        }
    }
}

/// An element, or a piece of text where there is no tag.
fn node(tag: &str, text: &str) -> Node {
    let element = (!tag.is_empty()).then(|| document().create_element(tag).ok()).flatten();
    match element {
        Some(element) => element.into(),
        None => document().create_text_node(text).into(),
    }
}

fn insert(parent: &Node, node: &Node, before: Option<&Node>) {
    if parent.insert_before(node, before).is_err() {
        // An extension of the browser (a translator) has moved what stood there.
        let _ = parent.append_child(node);
    }
}

fn remove(gone: &Mounted) {
    if let Some(parent) = gone.node.parent_node() {
        let _ = parent.remove_child(&gone.node);
    }
    unmount(gone);
}

fn unmount(gone: &Mounted) {
    if let Some(hook) = gone.gone {
        hook();
    }
    gone.children.iter().for_each(unmount);
}

impl Target {
    /// Writes a value, or takes it off again. No attribute here has a name that a browser refuses.
    fn write(self, node: &Node, value: Option<&str>) {
        match self {
            Self::Attribute(name) => {
                if let Some(element) = node.dyn_ref::<web_sys::Element>() {
                    let _ = match value {
                        Some(value) => element.set_attribute(name, value),
                        None => element.remove_attribute(name),
                    };
                }
            }
            Self::Style(name) => {
                if let Some(element) = node.dyn_ref::<HtmlElement>() {
                    let _ = element.style().set_property(name, value.unwrap_or_default());
                }
            }
            Self::Checked => {
                if let Some(input) = node.dyn_ref::<HtmlInputElement>() {
                    input.set_checked(value.is_some_and(|value| !value.is_empty()));
                }
            }
            Self::Value => {
                let value = value.unwrap_or_default();
                if let Some(input) = node.dyn_ref::<HtmlInputElement>() {
                    input.set_value(value);
                } else if let Some(area) = node.dyn_ref::<HtmlTextAreaElement>() {
                    area.set_value(value);
                }
            }
        }
    }
}
