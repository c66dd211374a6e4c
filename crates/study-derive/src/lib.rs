//! `#[derive(FromJson)]`: a reader from a JSON value, from the same `#[serde(...)]` attributes that
//! serde's own readers go by.
//!
//! A reader of serde's is a state machine that takes keys in any order from any format: some
//! kilobytes of code a type. Here a type asks a tree for its keys: a call a field. Understood are
//! `default`, `default = "path"`, `rename`, `rename_all` (camelCase, snake_case, kebab-case),
//! `deny_unknown_fields`, and `remote = "Self"`, which marks an enum whose tag stands inside, under
//! `type`. Keys that say how to write are passed over; others are an error.
//!
//! `#[from_json(off_page)]` marks what no page asks for (hypotheses, the paths of captures): the module in
//! the browser leaves it empty and carries no reader for it. That module knows no keys but those that it
//! reads, and takes others as well: the server has refused them.

use proc_macro::TokenStream;
use proc_macro2::{Span, TokenStream as Tokens};
use quote::quote;
use syn::{
    Attribute, Data, DeriveInput, Error, Expr, Field, Fields, Ident, LitStr, Path, Token, Variant,
    parse_macro_input,
};

/// Derives a reader from a JSON value.
#[proc_macro_derive(FromJson, attributes(serde, from_json))]
pub fn from_json(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    implement(&input).unwrap_or_else(Error::into_compile_error).into()
}

/// What the attributes of a type, a variant or a field say.
#[derive(Default)]
struct Said {
    rename: Option<String>,
    rename_all: Option<String>,
    /// What a missing key means: the type's own default, or that of a function.
    default: Option<Option<Path>>,
    deny_unknown_fields: bool,
    tag_inside: bool,
    /// No page asks for it.
    off_page: bool,
}

impl Said {
    fn of(attributes: &[Attribute]) -> Result<Self, Error> {
        let mut said = Self::default();
        for attribute in attributes.iter().filter(|each| each.path().is_ident("from_json")) {
            attribute.parse_nested_meta(|meta| {
                said.off_page = meta.path.is_ident("off_page");
                if said.off_page { Ok(()) } else { Err(meta.error("only off_page is known")) }
            })?;
        }
        for attribute in attributes.iter().filter(|each| each.path().is_ident("serde")) {
            attribute.parse_nested_meta(|meta| {
                let text = |meta: &syn::meta::ParseNestedMeta| -> Result<LitStr, Error> {
                    meta.value()?.parse::<LitStr>()
                };
                let Some(word) = meta.path.get_ident().map(ToString::to_string) else {
                    return Err(meta.error("a word is missing"));
                };
                match word.as_str() {
                    "rename" => said.rename = Some(text(&meta)?.value()),
                    "rename_all" => said.rename_all = Some(text(&meta)?.value()),
                    "deny_unknown_fields" => said.deny_unknown_fields = true,
                    "remote" => said.tag_inside = text(&meta)?.value() == "Self",
                    "default" if meta.input.peek(Token![=]) => {
                        said.default = Some(Some(text(&meta)?.parse()?));
                    }
                    "default" => said.default = Some(None),
                    "skip_serializing_if" => drop(meta.value()?.parse::<Expr>()?),
                    other => return Err(meta.error(format!("{other} is not read here"))),
                }
                Ok(())
            })?;
        }
        Ok(said)
    }

    /// The key or word of a field or variant, by its own name or by the rule of `all`.
    fn name(&self, ident: &Ident, all: &Said) -> Result<String, Error> {
        if let Some(name) = &self.rename {
            return Ok(name.clone());
        }
        let plain = ident.to_string();
        let words = words(&plain);
        Ok(match all.rename_all.as_deref() {
            None => plain,
            Some("snake_case") => words.join("_"),
            Some("kebab-case") => words.join("-"),
            Some("camelCase") => {
                let capital = |word: &String| {
                    let (first, rest) = word.split_at(1);
                    first.to_uppercase() + rest
                };
                words[..1].iter().cloned().chain(words[1..].iter().map(capital)).collect()
            }
            Some(other) => return Err(Error::new(ident.span(), format!("{other} is not known"))),
        })
    }
}

/// The words of `two_words` or `TwoWords`, in lower case.
fn words(ident: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for part in ident.split('_').filter(|part| !part.is_empty()) {
        let mut begins = true;
        for letter in part.chars() {
            if begins || letter.is_uppercase() {
                words.push(String::new());
            }
            begins = false;
            if let Some(word) = words.last_mut() {
                word.extend(letter.to_lowercase());
            }
        }
    }
    words
}

fn implement(input: &DeriveInput) -> Result<Tokens, Error> {
    let said = Said::of(&input.attrs)?;
    let name = &input.ident;
    let body = match &input.data {
        Data::Struct(data) => {
            let known = known(&data.fields, &said)?;
            let read = match said.default {
                Some(_) => in_place(&data.fields, &said)?,
                None => {
                    let fields = fields(&data.fields, &said)?;
                    quote! { Self { #fields } }
                }
            };
            quote! {
                // The server has refused what is not known; its keys need not be downloaded to be refused
                // again.
                const KNOWN: &[&str] = if cfg!(target_arch = "wasm32") { &[] } else { &[#known] };
                faults.object(value, KNOWN);
                #read
            }
        }
        Data::Enum(data) if said.tag_inside => {
            let arms = data.variants.iter().map(|variant| tagged(variant, &said));
            let arms = arms.collect::<Result<Vec<Tokens>, Error>>()?;
            let words = data
                .variants
                .iter()
                .map(|variant| Said::of(&variant.attrs)?.name(&variant.ident, &said))
                .collect::<Result<Vec<String>, Error>>()?;
            // A word that is not known stands for the first kind.
            let (first, rest) = arms.split_first().ok_or_else(|| empty(name))?;
            let (first_word, rest_words) = words.split_first().ok_or_else(|| empty(name))?;
            quote! {
                let word = faults.tag(value);
                match word {
                    #(#rest_words => #rest,)*
                    other => {
                        if other != #first_word {
                            faults.unknown_word(value, other);
                        }
                        #first
                    }
                }
            }
        }
        Data::Enum(data) => {
            let first = &data.variants.first().ok_or_else(|| empty(name))?.ident;
            let mut arms = quote! {};
            for variant in &data.variants {
                let word = Said::of(&variant.attrs)?.name(&variant.ident, &said)?;
                let ident = &variant.ident;
                arms.extend(quote! { #word => Self::#ident, });
            }
            quote! {
                match faults.word(value) {
                    #arms
                    other => {
                        faults.unknown_word(value, other);
                        Self::#first
                    }
                }
            }
        }
        Data::Union(_) => return Err(Error::new(Span::call_site(), "a union is not read")),
    };
    Ok(quote! {
        impl ::mimique_study::from_json::FromJson for #name {
            fn from_json(
                value: &::serde_json::Value,
                faults: &mut ::mimique_study::from_json::Faults,
            ) -> Self {
                #body
            }
        }
    })
}

fn empty(name: &Ident) -> Error {
    Error::new(name.span(), "an enum without variants is not read")
}

/// One kind of thing that its tag names.
fn tagged(variant: &Variant, all: &Said) -> Result<Tokens, Error> {
    // Its word is read, and refused where it cannot be.
    Said::of(&variant.attrs)?.name(&variant.ident, all)?;
    let ident = &variant.ident;
    Ok(match &variant.fields {
        Fields::Unit => quote! { Self::#ident },
        Fields::Unnamed(_) => quote! {{
            faults.besides(&["type"]);
            Self::#ident(::mimique_study::from_json::FromJson::from_json(value, faults))
        }},
        named @ Fields::Named(_) => {
            // `rename_all` of an enum is for its variants alone.
            let fields = fields(named, &Said::default())?;
            quote! { Self::#ident { #fields } }
        }
    })
}

/// `field: read(value, "key", faults)` and so on.
fn fields(fields: &Fields, all: &Said) -> Result<Tokens, Error> {
    let mut tokens = quote! {};
    for (ident, key, said) in named(fields, all)? {
        let read = match &said.default {
            Some(Some(path)) => {
                quote! { ::mimique_study::from_json::or_else(value, #key, faults, #path) }
            }
            Some(None) => {
                quote! { ::mimique_study::from_json::or_else(value, #key, faults, Default::default) }
            }
            None => quote! { ::mimique_study::from_json::required(value, #key, faults) },
        };
        let read = match said.off_page {
            true => quote! {
                if cfg!(target_arch = "wasm32") { Default::default() } else { #read }
            },
            false => read,
        };
        tokens.extend(quote! { #ident: #read, });
    }
    Ok(tokens)
}

/// The type's default, and each field that is given put in its place; a field's own default before it.
fn in_place(fields: &Fields, all: &Said) -> Result<Tokens, Error> {
    let mut tokens = quote! { let mut whole = <Self as Default>::default(); };
    for (ident, key, said) in named(fields, all)? {
        let own = match &said.default {
            Some(Some(path)) => quote! { whole.#ident = #path(); },
            Some(None) => quote! { whole.#ident = Default::default(); },
            None => quote! {},
        };
        let put =
            quote! { ::mimique_study::from_json::put(value, #key, faults, &mut whole.#ident); };
        let put = match said.off_page {
            true => quote! { if !cfg!(target_arch = "wasm32") { #put } },
            false => put,
        };
        tokens.extend(quote! { #own #put });
    }
    tokens.extend(quote! { whole });
    Ok(tokens)
}

/// The keys of a type that refuses others; none of one that does not.
fn known(fields: &Fields, all: &Said) -> Result<Tokens, Error> {
    if !all.deny_unknown_fields {
        return Ok(quote! {});
    }
    let keys: Vec<String> = named(fields, all)?.into_iter().map(|(_, key, _)| key).collect();
    Ok(quote! { #(#keys),* })
}

fn named<'a>(fields: &'a Fields, all: &Said) -> Result<Vec<(&'a Ident, String, Said)>, Error> {
    let one = |field: &'a Field| {
        let said = Said::of(&field.attrs)?;
        let Some(ident) = &field.ident else {
            return Err(Error::new_spanned(field, "a field without a name is not read"));
        };
        let key = said.name(ident, all)?;
        Ok((ident, key, said))
    };
    fields.iter().map(one).collect()
}
