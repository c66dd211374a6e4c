//! What stands on the page, and the pass that makes it what it should be.

use std::cell::RefCell;
use std::rc::Rc;

use gloo_events::{EventListener, EventListenerOptions};
use gloo_utils::document;
use wasm_bindgen::JsCast as _;
use web_sys::{HtmlElement, HtmlInputElement, HtmlTextAreaElement, Node};

use super::{Dispatch, Element, FieldEvent, Handler, Hook, Parts, Target};

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
