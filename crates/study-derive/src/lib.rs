//! `#[derive(FromJson)]`: a reader from a JSON value, from the same `#[serde(...)]` attributes that
//! serde's own readers go by.
//!
//! A reader of serde's is a state machine that takes keys in any order from any format: some
//! kilobytes of code a type. Here a type asks a tree for its keys: a call a field. Understood are
//! `default`, `default = "path"`, `rename`, `rename_all` (camelCase, snake_case, kebab-case),
//! `deny_unknown_fields`, and `remote = "Self"`, which marks an enum whose tag stands inside, under
//! `type`. Keys that say how to write are passed over; others are an error.

use proc_macro::TokenStream;
use proc_macro2::{Span, TokenStream as Tokens};
use quote::quote;
use syn::{
    Attribute, Data, DeriveInput, Error, Expr, Field, Fields, Ident, LitStr, Path, Token, Variant,
    parse_macro_input,
};

/// Derives a reader from a JSON value.
#[proc_macro_derive(FromJson, attributes(serde))]
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
}

impl Said {
    fn of(attributes: &[Attribute]) -> Result<Self, Error> {
        let mut said = Self::default();
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
            let fields = fields(&data.fields, &said)?;
            let whole = match said.default {
                Some(_) => quote! { let whole = <Self as Default>::default(); },
                None => quote! {},
            };
            let known = known(&data.fields, &said)?;
            quote! {
                let map = ::mimique_study::from_json::object(value)?;
                #whole
                let read = Self { #fields };
                #known
                Ok(read)
            }
        }
        Data::Enum(data) if said.tag_inside => {
            let arms = data.variants.iter().map(|variant| tagged(variant, &said));
            let arms = arms.collect::<Result<Tokens, Error>>()?;
            quote! {
                let map = ::mimique_study::from_json::object(value)?;
                match ::mimique_study::from_json::word(map.get("type"))? {
                    #arms
                    other => Err(::mimique_study::from_json::unknown_word(other)),
                }
            }
        }
        Data::Enum(data) => {
            let mut arms = quote! {};
            for variant in &data.variants {
                let word = Said::of(&variant.attrs)?.name(&variant.ident, &said)?;
                let ident = &variant.ident;
                arms.extend(quote! { #word => Ok(Self::#ident), });
            }
            quote! {
                match ::mimique_study::from_json::word(Some(value))? {
                    #arms
                    other => Err(::mimique_study::from_json::unknown_word(other)),
                }
            }
        }
        Data::Union(_) => return Err(Error::new(Span::call_site(), "a union is not read")),
    };
    Ok(quote! {
        impl ::mimique_study::from_json::FromJson for #name {
            fn from_json(
                value: &::serde_json::Value,
            ) -> ::core::result::Result<Self, ::mimique_study::from_json::Mistake> {
                #body
            }
        }
    })
}

/// One kind of thing, by its tag.
fn tagged(variant: &Variant, all: &Said) -> Result<Tokens, Error> {
    let word = Said::of(&variant.attrs)?.name(&variant.ident, all)?;
    let ident = &variant.ident;
    Ok(match &variant.fields {
        Fields::Unit => quote! { #word => Ok(Self::#ident), },
        Fields::Unnamed(_) => quote! {
            #word => Ok(Self::#ident(::mimique_study::from_json::untagged(map)?)),
        },
        named @ Fields::Named(_) => {
            // `rename_all` of an enum is for its variants alone.
            let fields = fields(named, &Said::default())?;
            quote! { #word => Ok(Self::#ident { #fields }), }
        }
    })
}

/// `field: read(map, "key")?` and so on.
fn fields(fields: &Fields, all: &Said) -> Result<Tokens, Error> {
    let mut tokens = quote! {};
    for (ident, key, said) in named(fields, all)? {
        let read = match (&said.default, &all.default) {
            (Some(Some(path)), _) => {
                quote! { ::mimique_study::from_json::or_else(map, #key, #path)? }
            }
            (Some(None), _) => {
                quote! { ::mimique_study::from_json::or_else(map, #key, Default::default)? }
            }
            (None, Some(_)) => {
                quote! { ::mimique_study::from_json::or(map, #key, whole.#ident)? }
            }
            (None, None) => quote! { ::mimique_study::from_json::required(map, #key)? },
        };
        tokens.extend(quote! { #ident: #read, });
    }
    Ok(tokens)
}

/// Refuses keys that are none of the type's.
fn known(fields: &Fields, all: &Said) -> Result<Tokens, Error> {
    if !all.deny_unknown_fields {
        return Ok(quote! {});
    }
    let keys: Vec<String> = named(fields, all)?.into_iter().map(|(_, key, _)| key).collect();
    Ok(quote! { ::mimique_study::from_json::only(map, &[#(#keys),*])?; })
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
