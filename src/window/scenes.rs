//! Example scenes that come with the program.

macro_rules! scenes {
    ($($name:literal),* $(,)?) => {
        /// Names and texts of the files in `scenes/`, `scenes/clouds/` and `scenes/fog/`.
        pub const SCENES: &[(&str, &str)] =
            &[$(($name, include_str!(concat!("../../scenes/", $name, ".toml")))),*];
    };
}

scenes!(
    "noon",
    "golden-hour",
    "twilight",
    "moonlight",
    "hills",
    "mountains",
    "airliner",
    "orbit",
    "mars",
    "clouds/fair-cumulus",
    "clouds/overcast-stratus",
    "clouds/sunset",
    "clouds/thin-cirrus",
    "clouds/towering-congestus",
    "clouds/inside-a-cloud",
    "fog/valley-morning",
    "fog/street-lamp",
    "fog/two-colours",
    "fog/glowing-gas",
    "fog/smoke-before-sun",
    "fog/under-clouds",
    "fog/lightning",
);

/// The scene that the window opens with where none is named.
pub const FIRST: (&str, &str) = SCENES[1];
