//! Options of policies, of estimators and of uses of trust.

/// Options, each with its default behind it: a structure that is written as `(name: value)`, in which any may
/// be left out and no other may stand.
#[macro_export]
macro_rules! options {
    ($(#[$of:meta])* $see:vis struct $Options:ident {
        $($(#[$what:meta])* $own:vis $option:ident: $Type:ty = $default:expr,)+
    }) => {
        $(#[$of])*
        #[derive(Debug, Clone, PartialEq, ::serde::Serialize, ::serde::Deserialize)]
        #[serde(default, deny_unknown_fields)]
        $see struct $Options {
            $($(#[$what])* $own $option: $Type,)+
        }

        impl Default for $Options {
            fn default() -> Self {
                Self { $($option: $default),+ }
            }
        }
    };
}
