# Recipes for people; `just ci` is exactly what CI runs.

# All that CI checks
ci:
    bash .ci/run

# 100 seeds of paper.ron under all five policies: nobody stuck, nothing lost, no number undefined
soak:
    cargo run --release --package experiments --example soak

# 500 random feasible worlds of 2 to 50 robots: who does not get there, and why
worlds:
    cargo run --release --package experiments --example worlds

# What a step costs: full simulator against raw physics, stage by stage
bench:
    cargo bench --bench speed

# New golden hashes of the small worlds; say in CHANGELOG.md why numbers change
golden:
    cargo run --release --package experiments --example golden -- --write
