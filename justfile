# Recipes for people; `just ci` is exactly what CI runs.

# All that CI checks
ci:
    bash .ci/run

# All that CI checks, and what takes longer than it may: the page of the laboratory, built from nothing and tried in Node and in a browser
ci-full: ci
    bash .ci/lab --test

# The Python package: wheel, types, tests, and the programs of its pages, in a virtual environment of its own
python:
    bash .ci/python

# The laboratory in one page: target/lab/usar-lab.html (docs/lab.md); installs Debian's rustc-web and rust-web-src
lab:
    bash .ci/lab

# 500 random worlds in the open, 500 with rooms, 500 with crowds and doors from one lane on, 900 s each, and 100 seeds of paper.ron under every policy: violations, internal errors, fleets and robots that do not get on; `0 100 600 paper` for the last alone
worlds *arguments:
    cargo run --release --bin xtask -- worlds {{arguments}}

# How well robots pass one another: 33 problems of the literature, 20 seeds each; `--help` for options
navigation *arguments:
    cargo run --release --bin xtask -- navigation {{arguments}}

# Crowds at doors and in corridors beside measured people, and the problems of CADRL; `--out docs` renews docs/movement.md
movement *arguments:
    cargo run --release --bin xtask -- movement {{arguments}}

# 510 random worlds with the engine at rest in quiet steps and with the engine always on: every hash is the same
quiet *arguments:
    cargo run --release --bin xtask -- quiet {{arguments}}

# Other methods on the same problems (ORCA, HRVO, HL by the public Python packages): half an hour; renews peers.csv and square.csv in crates/xtask/peers
peers:
    cargo run --release --bin xtask -- navigation --seeds 5 --worlds target/worlds.jsonl
    python3 -m venv target/peers
    target/peers/bin/pip install --quiet navground==0.7.0 pyrvo==0.4.3 numpy==2.4.6
    target/peers/bin/python crates/xtask/peers/peers.py target/worlds.jsonl crates/xtask/peers/peers.csv
    cargo run --release --bin xtask -- movement --worlds target/squares.jsonl
    target/peers/bin/python crates/xtask/peers/square.py target/squares.jsonl crates/xtask/peers/square.csv

# A sweep on Slurm itself, with a task killed and one cancelled: installs Debian's slurm-wlm, needs root
slurm:
    bash .ci/slurm

# 500 random scenarios of all kinds, with distributions and timelines: a minute of each with every invariant checked
scenarios *arguments:
    cargo run --release --bin xtask -- scenarios {{arguments}}

# The pages made from the code: docs/scenarios-reference.md, docs/limits.md, docs/columns.md, docs/events.md, and the schemas of files
reference:
    cargo run --bin xtask -- reference

# Every command of the pages, in one fresh folder, also those that take minutes
commands:
    cargo test --release --features usar/full --test suite -- --include-ignored tutorials::

# The pages of docs/ as a book in target/book; index.html opens from disk, with search
book:
    bash .ci/book

# A release in target/dist: tests, the program for glibc 2.17 as archive and Debian package, packages, checksums, notes; `--dry-run` sets no tag
release *arguments:
    bash .ci/release {{arguments}}

# Licences, sources and versions of all dependencies; needs cargo-deny
deny:
    cargo deny check licenses bans sources

# Lines of code and words by crate, beside the ceiling in crates/xtask/ceiling.ron: above it this fails, and CI as well
weight:
    cargo run --bin xtask -- weight

# What a step costs: full simulator against raw physics, stage by stage
bench:
    cargo bench --bench speed

# The same for large teams, and in the same minute the steps of other public libraries: RVO2, navground, Box2D, VMAS
bench-peers:
    python3 -m venv target/peers
    target/peers/bin/pip install --quiet navground==0.7.0 pyrvo==0.4.3 numpy==2.4.6 Box2D==2.3.10 vmas==1.5.2
    cargo bench --bench speed -- density-12 density-100 density-1000
    target/peers/bin/python crates/xtask/peers/speed.py

# Instructions of fixed pieces of trials and of the grouping search against the committed figures; `--write` renews them
instructions *arguments:
    bash .ci/instructions {{arguments}}

# 10,000 robots for a minute: time, memory, hash; other numbers and fields of the scenario as arguments
scale *arguments:
    cargo run --release --bin xtask -- scale {{arguments}}

# New golden hashes of the small worlds; say in CHANGELOG.md why numbers change
golden:
    cargo run --release --bin xtask -- golden --write

# The page of `usar view` from viewer/, into crates/usar/assets/viewer.html, where the program takes it from
viewer:
    npm --prefix viewer ci --ignore-scripts --no-audit --no-fund
    npm --prefix viewer run build

# The numbers in docs/, anew: the commands before each block are run; their results must be there (`just results`)
pages *pages:
    cargo build --release --package usar --package usar-yang2021 --features usar/full
    cargo run --release --bin xtask -- pages {{pages}}

# The results that pages are made of, by the ledger docs/results.csv: only what is older than the program is run, and it goes on where it was broken off; `--list`, `--on cluster`, or names of results
results *arguments:
    cargo build --release --package usar --package usar-yang2021 --features usar/full
    cargo run --release --bin xtask -- results {{arguments}}

# How often each kind of interval holds the truth, and how often verdicts of `usar test` are wrong (docs/experiments.md): ten minutes
coverage *arguments:
    cargo run --release --bin xtask -- coverage {{arguments}}
