//! Limits of scenarios: what each value may be. `docs/limits.md` is made from this file.

use teaming::question::MAX_TASKS;

ron_tree::limits! {
    /// Bytes of a name: a scenario's, a role's, a task's, a need's. Letters, digits, `-` and `_`, which all
    /// systems take as names of files.
    NAME_BYTES: "*.name" = 1, 64;
    /// Simulated time of a trial, in seconds.
    DURATION_S: "duration_s" = 1, 86_400;
    /// Length of a step, in seconds.
    DT_S: "dt_s" = 0.001, 0.05;
    /// Time from one control step to the next, in seconds.
    CONTROL_PERIOD_S: "control_period_s" = 0.001, 1;
    /// Width and height of the arena, in metres. Positions are numbers of single precision: at 8,000 m they
    /// are 0.5 mm apart, which is what contacts and the routes between them bear.
    ARENA_M: "arena_m[*]" = 2, 8_000;

    /// Robots of a team, all rows together.
    ROBOTS: "team" = 1, 20_000;
    /// Rows of a team.
    ROWS: "team" = 1, 20_000;
    /// Distance between the first and the last robot of a row, in metres.
    ROW_WIDTH_M: "team[*].width_m" = 0, ARENA_M.most;
    /// A level that is given for a row, in percent.
    LEVEL: "team[*].levels.*" = 0.01, 100;

    /// Roles.
    ROLES: "roles" = 1, 64;
    /// Radius of a robot, in metres.
    ROBOT_RADIUS_M: "roles.*.radius_m" = 0.05, 5;
    /// Mass of a robot, in kilograms.
    ROBOT_MASS_KG: "roles.*.mass_kg" = 0.1, 10_000;
    /// Health points at 100 %.
    HP: "roles.*.hp" = 0.001, 1e6;
    /// Battery capacity at 100 %.
    ENERGY: "roles.*.energy" = 0.001, 1e6;
    /// Top speed, in metres per second; times the length of a step, at most the robot's radius, and 0.12 m
    /// where debris can be pushed.
    SPEED_MPS: "roles.*.speed_mps" = 0.05, 20;
    /// Acceleration, in metres per second squared.
    ACCELERATION_MPS2: "roles.*.acceleration_mps2" = 0.05, 100;
    /// Range within which debris and radiation are noticed, in metres.
    SENSING_M: "roles.*.sensing_m" = 0, 1_000;
    /// Range within which rescuees are seen, in metres.
    OBSERVING_M: "roles.*.observing_m" = 0, 1_000;
    /// Standard deviation of the place at which a rescuee is seen, in metres.
    SIGHT_NOISE_M: "roles.*.sight.noise_m" = 0, 100;
    /// Rescuees that a robot sees in a minute and that do not exist.
    FALSE_ALARMS: "roles.*.sight.false_alarms_per_min" = 0, 60;
    /// Rescuees on board.
    CAPACITY: "roles.*.capacity" = 0, 10_000;
    /// Resources of a robot.
    RESOURCES: "roles.*.resources" = 0, 10_000;
    /// Constants of a role.
    CONSTANTS: "roles.*.constants" = 0, 64;
    /// Value of a constant.
    CONSTANT: "roles.*.constants.*" = 0, 1e9;

    /// Needs.
    NEEDS: "needs" = 1, 64;
    /// Weight of a need.
    WEIGHT: "needs.*.weight" = 0, 1e9;
    /// Mean of an initial level, in percent.
    LEVEL_MEAN: "initial_levels.*.mean" = 0, 100;
    /// Standard deviation of an initial level, in percent points.
    LEVEL_SD: "initial_levels.*.sd" = 0, 100;

    /// Tasks; none where there are errands.
    TASKS: "tasks" = 1, MAX_TASKS;
    /// Difficulty of a task.
    DIFFICULTY: "tasks.*.difficulty" = 0, 1_000_000;
    /// Width and height of a block of rescuees, in metres.
    BLOCK_M: "tasks.*.size_m[*]" = 0, 10_000;
    /// Rescuees along the width or the height of a block.
    GRID: "tasks.*.grid[*]" = 0, 1_000;
    /// Rescuees of all tasks.
    RESCUEES: "tasks" = 0, 1_000_000;
    /// Members of a role that a task asks for.
    QUOTA: "tasks.*.quota.*" = 0, ROBOTS.most;
    /// Worth of a rescuee.
    VALUE: "tasks.*.value" = 0, 1e9;
    /// What the needs of a group should add up to.
    REQUIRED: "tasks.*.requires.*" = 0, 1e9;
    /// Expected time of a task's work, in seconds.
    WORK_S: "tasks.*.duration_s" = 0, DURATION_S.most;
    /// Pieces of debris drawn for one task.
    SAMPLED_DEBRIS: "tasks.*.sampled.debris" = 0, 10_000;
    /// Radiation zones drawn for one task.
    SAMPLED_ZONES: "tasks.*.sampled.radiation" = 0, 1_000;

    /// Errands: at most one for each robot.
    ERRANDS: "errands" = 0, ROBOTS.most;
    /// Places of one errand.
    PLACES: "errands[*].to" = 1, 10_000;

    /// Pieces of debris at known places.
    DEBRIS: "debris" = 0, 100_000;
    /// Radius of a disc of debris, in metres.
    DISC_RADIUS_M: "debris[*].shape.Disc" = 0.05, 100;
    /// Width and height of a box of debris, in metres.
    BOX_M: "debris[*].shape.Box[*]" = 0.1, 1_000;
    /// Corners of a polygon.
    CORNERS: "debris[*].shape.Polygon" = 3, 64;
    /// A coordinate of a corner, in metres from the polygon's origin.
    CORNER_M: "debris[*].shape.Polygon[*][*]" = -1_000, 1_000;
    /// Rotation of a piece of debris, in degrees.
    ROTATION_DEG: "debris[*].rotation_deg" = -360, 360;
    /// Mass of a movable piece, in kilograms.
    PIECE_MASS_KG: "debris[*].movable.mass_kg" = 0.1, 100_000;
    /// Friction of a movable piece.
    FRICTION: "debris[*].movable.friction" = 0, 10;
    /// Walls.
    WALLS: "walls" = 0, 10_000;
    /// Thickness of a wall, in metres.
    WALL_THICKNESS_M: "walls[*].thickness_m" = 0.1, 100;
    /// Doors of a wall.
    DOORS: "walls[*].doors" = 0, 100;
    /// Width of a door, in metres.
    DOOR_WIDTH_M: "walls[*].doors[*].width_m" = 0.1, 1_000;
    /// Radiation zones at known places. Each is looked at wherever a route is planned.
    ZONES: "radiation" = 0, 1_000;
    /// Radius of a radiation zone, in metres.
    ZONE_RADIUS_M: "radiation[*].radius_m" = 0.01, 1_000;
    /// Radius of a sampled thing, in metres.
    SAMPLED_RADIUS_M: "sampled.*_radius_m[*]" = 0.05, 100;
    /// Free distance between sampled pieces of debris, in metres.
    GAP_M: "sampled.gap_m" = 0, 100;
    /// Half the width of the strip in which things are sampled, in metres.
    STRIP_M: "sampled.strip_m" = 0.1, 10_000;

    /// Values that have names.
    VALUES: "values" = 0, 1_000;
    /// Length of a value that has a name, in bytes.
    VALUE_BYTES: "values.*" = 1, 1_024;
    /// Distributions in the place of values.
    DRAWS: "a scenario" = 0, 1_000;
    /// Values of a `Choice([...])`.
    CHOICES: "Choice" = 1, 64;
    /// Entries of the list of scattered things.
    SCATTERS: "scatter" = 0, 100;
    /// Things that are placed anew in every trial, all entries together.
    SCATTERED: "scatter[*].count" = 0, 1_000;
    /// Events of the timeline.
    MOMENTS: "timeline" = 0, 1_000;
    /// Time of an event, in seconds.
    AT_S: "timeline[*].at_s" = 0, DURATION_S.most;
    /// What a robot loses of a level, in percent points.
    LOSS: "timeline[*].event.RobotLoses.energy" = 0, 100;

    /// Share of its speed that a robot keeps.
    SLOWED: "timeline[*].event.RobotSlows.factor" = 0.01, 1;
    /// Factor on the energy that a robot spends.
    FADED: "timeline[*].event.BatteryFades.factor" = 0.01, 100;

    /// Time between two reports, in seconds.
    REPORT_S: "reports.every_s" = 1, 3_600;
    /// Roles with gauges.
    SENSORS: "reports.sensors" = 0, ROLES.most;
    /// Standard deviation of a gauge, in percent points.
    GAUGE_SD: "reports.sensors.*.*.sd" = 0, 100;
    /// Error of a gauge or of a lie, in percent points.
    GAUGE_BIAS: "reports.sensors.*.*.bias" = -100, 100;
    /// Growing error of a gauge, in percent points an hour.
    GAUGE_DRIFT: "reports.sensors.*.*.drift_per_h" = -1_000, 1_000;
    /// A probability or a share.
    PROBABILITY: "reports.sensors.*.*.dropout" = 0, 1;
    /// Step of a gauge, in percent points.
    GAUGE_QUANTUM: "reports.sensors.*.*.quantum" = 0, 100;
    /// Standard deviation of a speed seen, as a share of it.
    WITNESS_SD: "reports.witness.sd" = 0, 1;
    /// Looks at a group-mate.
    LOOKS: "reports.witness.least_looks" = 1, 1_000_000;
    /// Range of a radio, in metres.
    RADIO_RANGE_M: "medium.range_m" = 0.1, 10_000;
    /// Delay of a message, in seconds.
    DELAY_S: "medium.delay_s" = 0, 3_600;
    /// How often a lost message is sent again.
    RESENDS: "medium.resend.times" = 0, 100;
    /// What a message costs its sender.
    MESSAGE_ENERGY: "medium.energy_per_message" = 0, 1e6;
    /// Capacity of a channel, in kilobits a second.
    KBPS: "medium.kbps" = 0.01, 1e6;
    /// Length of a message, in bytes.
    MESSAGE_BYTES: "medium.bytes" = 1, 65_536;
    /// Time on the channel besides the message, in milliseconds.
    OVERHEAD_MS: "medium.overhead_ms" = 0, 10_000;
    /// A loss, in dB.
    DECIBEL: "medium.path.*_db" = 0, 500;
    /// Path loss exponent.
    PATH_EXPONENT: "medium.path.n" = 0, 10;
    /// Standard deviation of shadowing, in dB.
    SHADOWING_DB: "medium.path.sigma_db" = 0.001, 100;
    /// Blackouts.
    BLACKOUTS: "medium.blackouts" = 0, 100;
    /// Radius of a blackout, in metres.
    BLACKOUT_RADIUS_M: "medium.blackouts[*].radius_m" = 0.1, 10_000;
    /// Entries of the list of deceit.
    DECEITS: "deceit" = 0, 1_000;
    /// A level that is said, in percent.
    SAID_LEVEL: "deceit[*].floor" = 0, 100;
    /// Factor of a lie.
    LIE_FACTOR: "deceit[*].lie.Scale.factor" = 0, 1_000;
    /// Period of a lie, in seconds.
    LIE_PERIOD_S: "deceit[*].lie.OnOff.period_s" = 0.001, 86_400;

    /// A cost, in percent or points.
    RATE: "costs.*.*" = 0, 100;
    /// What work costs in a second, in percent or points.
    WORK_RATE: "costs.work.*" = 0, 100;
    /// A threshold, in percent.
    THRESHOLD: "mission.*_threshold" = 0, 99;
    /// Reserve for the way to rest.
    REST_RESERVE: "mission.rest_reserve" = 0, 10;
    /// Time between two attempts to form groups, in seconds.
    RETRY_S: "mission.decides.Robots.retry_s" = 1, 3_600;
    /// Time between two tellings of a claim, in seconds.
    CLAIM_AGAIN_S: "mission.claims.ByRadio.again_s" = 0.1, 3_600;
    /// Longest time of a negotiation, in seconds.
    DEADLINE_S: "mission.decides.Robots.deadline_s" = 0, 3_600;
    /// Time at rest, in seconds.
    REST_S: "mission.rest_s" = 0, 86_400;
    /// Time to load a rescuee, in seconds.
    LOADING_S: "mission.loading_s" = 0, 3_600;
    /// Reach of a robot, in metres; at least the radius of the largest robot that can carry.
    REACH_M: "mission.reach_m" = 0, 20;
    /// Margin of a task's area, in metres; at least the radius of the largest robot that can carry.
    AREA_MARGIN_M: "mission.area_margin_m" = 0, 1_000;
    /// Share of its speed that a group without a guide loses.
    BLIND_SPEED_LOSS: "mission.blind_speed_loss" = 0, 0.95;
    /// Share of its speed that a robot with a full load loses.
    LOAD_SPEED_LOSS: "mission.load_speed_loss" = 0, 0.95;
    /// Factor on speed and ranges without health.
    HEALTH_FLOOR: "mission.health_floor" = 0.05, 1;
    /// Time without progress, in seconds.
    CUT_OFF_S: "mission.cut_off_s" = 1, 86_400;
    /// Clearance of routes, in metres.
    CLEARANCE_M: "planning.clearance_m" = 0.02, 10;
    /// Price of exposure, in metres.
    EXPOSURE_PRICE_M: "planning.exposure_price_m" = 0, 1e6;
    /// Distance between robots under the rules of the paper, in metres.
    MARGIN_M: "conflicts.resolver.margin_m" = 0, 10;
    /// How far ahead the rules of the paper look, in seconds.
    HORIZON_S: "conflicts.resolver.horizon_s" = 0, 60;
    /// Steps without motion until the rules of the paper see a deadlock.
    DEADLOCK_STEPS: "conflicts.resolver.deadlock_steps" = 1, 100_000;
}
