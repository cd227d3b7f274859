//! Limits of sweeps and of tables that users write. `docs/limits.md` is made from this file.

ron_tree::limits! {
    /// Policies of a sweep, readings included.
    POLICIES: "policies" = 1, 10_000;
    /// Combinations of readings.
    READINGS: "readings" = 0, 10_000;
    /// Axes of a sweep.
    AXES: "axes" = 0, 16;
    /// Values of an axis, or of an option in `readings`.
    AXIS_VALUES: "axes.*" = 1, 1_000;
    /// Cases that the axes span.
    CASES: "axes" = 1, 10_000;
    /// Bytes of all cases together, each as a scenario in full.
    CASE_BYTES: "axes" = 0, 256 << 20;
    /// Fields that a sweep file sets.
    SETTINGS: "set" = 0, 1_000;
    /// Trials for each case and policy.
    TRIALS: "trials" = 1, 1_000_000;
    /// Seeds that are listed.
    SEEDS: "seeds" = 1, 100_000;
    /// Bodies times steps of one trial, about as many as take one or two minutes to simulate; more needs
    /// `--allow-expensive`.
    TRIAL_WORK: "a trial" = 0, 1e9;
    /// Bodies times steps of all trials of a sweep; more needs `--allow-expensive`.
    SWEEP_WORK: "a sweep" = 0, 1e12;
    /// Columns of a table.
    COLUMNS: "a table" = 1, 1_000;
    /// Rows of a table.
    TABLE_ROWS: "a table" = 0, 100_000;
    /// Robots of a team in a table.
    TEAM_ROBOTS: "a team in a table" = 1, 500;
    /// Bytes of a snapshot.
    SNAPSHOT_BYTES: "a snapshot" = 0, 256 << 20;
    /// Bytes of a recording.
    RECORDING_BYTES: "a recording" = 0, 256 << 20;
    /// Bytes of a manifest, or of another file of a folder of results that is read whole.
    STORED_BYTES: "a folder of results" = 0, store::files::FILE_BYTES;
    /// Bytes of one line of a journal: a trial.
    JOURNAL_LINE_BYTES: "journal.jsonl" = 0, store::LINE_BYTES;
}
