//! Elements as they should stand, and the mending of those that do: what a page says is built anew
//! with every change, and only what differs is touched. Focus, carets and running videos stay.
//!
//! No type parameters but at the border: one copy of the code serves every page.

use std::rc::Rc;

use wasm_bindgen::closure::Closure;
use wasm_bindgen::{JsCast as _, JsValue};

use crate::page;

/// What a field says when something happens to it: its value (of a key press, the key), and whether
/// it is checked.
pub struct Given {
    /// Value or key.
    pub value: String,
    /// Of check boxes.
    pub checked: bool,
}

type Handler = Rc<dyn Fn(Given)>;
type Hook = Box<dyn FnOnce(&JsValue)>;

/// An element as it should stand.
pub struct Element(Box<Parts>);

#[derive(Default)]
struct Parts {
    /// Empty for a piece of text.
    tag: &'static str,
    key: String,
    text: String,
    attributes: Vec<(&'static str, String)>,
    on: Vec<(&'static str, Handler)>,
    children: Vec<Element>,
    live: Option<(Hook, fn())>,
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
    /// An attribute; `.name` is a property, `--name` one of the style.
    #[inline(never)]
    pub fn set(mut self, name: &'static str, value: &str) -> Self {
        self.0.attributes.push((name, value.to_owned()));
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
        let value = if name.starts_with("aria-") || name.starts_with('.') { "true" } else { "" };
        self.set(name, value)
    }

    /// Whether a field is checked.
    #[inline(never)]
    pub fn checked(self, on: bool) -> Self {
        self.set(".checked", if on { "true" } else { "" })
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

    /// What is done when something happens to it.
    pub fn on(self, name: &'static str, handler: impl Fn(Given) + 'static) -> Self {
        self.handle(name, Rc::new(handler))
    }

    #[inline(never)]
    fn handle(mut self, name: &'static str, handler: Handler) -> Self {
        self.0.on.push((name, handler));
        self
    }

    /// What is done with the node once it stands on the page, and once it has gone.
    pub fn live(mut self, stands: impl FnOnce(&JsValue) + 'static, gone: fn()) -> Self {
        self.0.live = Some((Box::new(stands), gone));
        self
    }
}

/// An element that stands on the page.
struct Standing {
    node: JsValue,
    tag: &'static str,
    key: String,
    text: String,
    attributes: Vec<(&'static str, String)>,
    listeners: Vec<Listener>,
    children: Vec<Standing>,
    gone: Option<fn()>,
}

struct Listener {
    name: &'static str,
    handler: Rc<std::cell::RefCell<Handler>>,
    _call: Closure<dyn FnMut(String, bool)>,
}

/// A place on the page and what stands there.
pub struct Place {
    node: JsValue,
    standing: Vec<Standing>,
}

impl Place {
    /// The place of the pages.
    pub fn root() -> Self {
        Self { node: page::root(), standing: Vec::new() }
    }

    /// Mends what stands there.
    pub fn show(&mut self, elements: Vec<Element>) {
        let mut hooks = Vec::new();
        mend_children(&self.node, &mut self.standing, elements, &mut hooks);
        for (hook, node) in hooks {
            hook(&node);
        }
    }
}

type Hooks = Vec<(Hook, JsValue)>;

fn create(Element(parts): Element, hooks: &mut Hooks) -> Standing {
    let Parts { tag, key, text, attributes, on, children, live } = *parts;
    let node = if tag.is_empty() { page::text(&text) } else { page::element(tag) };
    for (name, value) in &attributes {
        page::set(&node, name, value);
    }
    let children: Vec<Standing> = children
        .into_iter()
        .map(|child| {
            let child = create(child, hooks);
            page::insert(&node, &child.node, &JsValue::UNDEFINED);
            child
        })
        .collect();
    let listeners = on.into_iter().map(|(name, handler)| listener(&node, name, handler)).collect();
    let gone = live.map(|(stands, gone)| {
        hooks.push((stands, node.clone()));
        gone
    });
    Standing { node, tag, key, text, attributes, listeners, children, gone }
}

fn listener(node: &JsValue, name: &'static str, handler: Handler) -> Listener {
    let handler = Rc::new(std::cell::RefCell::new(handler));
    let now = Rc::clone(&handler);
    let call = Closure::<dyn FnMut(String, bool)>::new(move |value, checked| {
        let handler = Rc::clone(&*now.borrow());
        handler(Given { value, checked });
    });
    page::listen(node, name, call.as_ref().unchecked_ref());
    Listener { name, handler, _call: call }
}

fn mend(old: &mut Standing, Element(parts): Element, hooks: &mut Hooks) {
    let parts = *parts;
    if old.tag.is_empty() {
        if old.text != parts.text {
            page::set_text(&old.node, &parts.text);
            old.text = parts.text;
        }
        return;
    }
    for (name, value) in &parts.attributes {
        let before = old.attributes.iter().find(|(each, _)| each == name);
        if before.is_none_or(|(_, before)| before != value) {
            page::set(&old.node, name, value);
        }
    }
    for (name, _) in &old.attributes {
        if !parts.attributes.iter().any(|(each, _)| each == name) {
            page::unset(&old.node, name);
        }
    }
    old.attributes = parts.attributes;
    for (name, handler) in parts.on {
        match old.listeners.iter().find(|each| each.name == name) {
            Some(listener) => *listener.handler.borrow_mut() = handler,
            None => old.listeners.push(listener(&old.node, name, handler)),
        }
    }
    mend_children(&old.node, &mut old.children, parts.children, hooks);
}

/// Elements keep their order, so one pass finds those that stay.
fn mend_children(node: &JsValue, old: &mut Vec<Standing>, new: Vec<Element>, hooks: &mut Hooks) {
    let mut rest = std::mem::take(old);
    // The next one is the last.
    rest.reverse();
    for element in new {
        let same = |each: &Standing| each.tag == element.0.tag && each.key == element.0.key;
        if let Some(at) = rest.iter().rposition(same) {
            for gone in rest.drain(at + 1..) {
                take_out(&gone);
            }
            if let Some(mut stays) = rest.pop() {
                mend(&mut stays, element, hooks);
                old.push(stays);
            }
        } else {
            let new = create(element, hooks);
            let before = rest.last().map_or(JsValue::UNDEFINED, |next| next.node.clone());
            page::insert(node, &new.node, &before);
            old.push(new);
        }
    }
    for gone in &rest {
        take_out(gone);
    }
}

fn take_out(gone: &Standing) {
    page::remove(&gone.node);
    farewell(gone);
}

fn farewell(gone: &Standing) {
    if let Some(hook) = gone.gone {
        hook();
    }
    gone.children.iter().for_each(farewell);
}
