//! Enums whose variants have names.

/// An enum with a name for each variant, written beside it. It gets `ALL`, its variants in their order, and
/// `name`.
#[macro_export]
macro_rules! named {
    ($(#[$of:meta])* $see:vis enum $Enum:ident { $($(#[$what:meta])* $Variant:ident = $name:literal,)+ }) => {
        $(#[$of])*
        $see enum $Enum {
            $($(#[$what])* $Variant,)+
        }

        impl $Enum {
            /// All variants, in their order.
            $see const ALL: [Self; [$($name),+].len()] = [$(Self::$Variant),+];

            /// Its name.
            $see fn name(self) -> &'static str {
                match self {
                    $(Self::$Variant => $name,)+
                }
            }
        }
    };
}
