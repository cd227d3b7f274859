//! Commands of earlier versions: each is answered with the command that is used instead.

/// The words of a command, and what is used instead. `{}` is the word behind them.
const RETIRED: [(&str, &str); 10] = [
    ("export figure", "`usar export {} --to NAME.pdf --figure FIGURE`"),
    ("export table", "`usar export {} --to NAME.csv`, with `--to -` for stdout"),
    ("export csv", "`usar export {} --to NAME.csv`"),
    ("export parquet", "`usar export {} --to NAME.parquet`"),
    ("export mcap", "`usar export {} --to NAME.mcap`"),
    (
        "export frames",
        "`usar export {} --to NAME.png` with `--at S` or `--trails`, or `--to 'NAME-%04d.png' --every S`",
    ),
    ("export video", "`usar export {} --to NAME.gif --every S`"),
    ("cluster status", "`squeue --me`; `usar cluster merge {} --out FOLDER` says which shards are missing"),
    ("self man", "`usar COMMAND --help`; the archive and the Debian package have manual pages"),
    ("cluster estimate", "`usar sweep {}`, whose progress tells the time that is left"),
];

/// For a command line that cannot be read and begins with a command of an earlier version: what is used
/// instead.
pub(crate) fn instead(words: &[String]) -> Option<String> {
    let [first, second, rest @ ..] = words else { return None };
    let old = format!("{first} {second}");
    let (_, new) = RETIRED.iter().find(|(retired, _)| *retired == old)?;
    let file = rest.first().filter(|word| !word.starts_with('-'));
    Some(format!("`usar {old}` is now {}", new.replace("{}", file.map_or("FILE", String::as_str))))
}
