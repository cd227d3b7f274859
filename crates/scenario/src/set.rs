//! Setting one field of a scenario by its path.

use ron_tree::{Problem, value_of};

use super::ScenarioFile;

impl ScenarioFile {
    /// Sets the field at a path such as `costs.energy.per_step` or `tasks.village.grid[0]` to a value in RON.
    /// Does not check the rules: they are checked when the file becomes a scenario.
    ///
    /// # Errors
    /// There is no such field, or the value is not of its type.
    pub fn set(&mut self, path: &str, value: &str) -> Result<(), Box<Problem>> {
        let (mut tree, value) = (self.tree(), value_of(path, value)?);
        tree.set(path, value, "a scenario")?;
        let canonical = tree.canonical(path);
        *self = match Self::read(&mut tree) {
            (Some(file), problems) if problems.is_empty() => file,
            (_, problems) => {
                let problem = problems.into_iter().next().unwrap_or_default();
                // In the words of the caller: `roles.carrier.hp`, not `roles[0].hp`.
                let inner = problem.field.strip_prefix(&canonical);
                let field = inner.map_or_else(|| problem.field.clone(), |inner| format!("{path}{inner}"));
                return Err(Box::new(Problem { field, ..problem }));
            }
        };
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use ron_tree::Node;

    use super::*;
    use crate::{Amount, DebrisShape};

    fn file() -> ScenarioFile {
        let row = "(role: \"robot\", count: 2, center: (5, 5), width_m: 2)";
        let debris = "(shape: Box(1, 2), at: (8, 8)), (shape: Disc(0.5), at: (3, 3))";
        let text = format!(
            "(name: \"t\", duration_s: 60, dt_s: 0.02, arena_m: (20, 20), team: [{row}], debris: [{debris}])"
        );
        Node::parse(&text).unwrap().read_as().unwrap()
    }

    #[test]
    fn one_field_is_set_and_no_other() {
        let mut set = file();
        set.set("costs.energy.per_step", "0.009").unwrap();
        set.set("roles.robot.speed_mps", "3").unwrap();
        set.set("debris[0].shape", "Box(3, 1)").unwrap();
        set.set("team[0].levels", "(energy: 50, hp: 60)").unwrap();
        set.set("arena_m[1]", "30").unwrap();
        let mut expected = file();
        expected.costs.energy.per_step = 0.009;
        expected.roles[0].speed_mps = 3.0;
        expected.debris[0].shape = DebrisShape::Box(3.0, 1.0);
        expected.team[0].levels =
            Some(crate::Levels { energy: Amount::Fixed(50.0), hp: Amount::Fixed(60.0) });
        expected.arena_m[1] = 30.0;
        assert_eq!(set, expected);
    }

    #[test]
    fn doors_and_sources_are_found_by_their_names() {
        let door = "(at_m: 3, width_m: 2), (at_m: 9, width_m: 2, name: \"gate\")";
        let text = format!(
            "(name: \"t\", duration_s: 60, dt_s: 0.02, arena_m: (20, 20), team: [], radiation: [(at: (1, 1), \
             radius_m: 2, name: \"leak\")], walls: [(from: (0, 9), to: (20, 9), doors: [{door}])])"
        );
        let mut set: ScenarioFile = Node::parse(&text).unwrap().read_as().unwrap();
        set.set("walls[0].doors.gate.width_m", "3").unwrap();
        set.set("walls[0].doors.gate.closed", "true").unwrap();
        set.set("walls[0].doors[0].name", "\"left\"").unwrap();
        set.set("radiation.leak.radius_m", "4").unwrap();
        let [left, gate] = &set.walls[0].doors[..] else { panic!("two doors") };
        assert_eq!((left.name.as_deref(), left.is_closed), (Some("left"), false));
        assert_eq!((gate.width_m, gate.is_closed), (3.0, true));
        assert!((set.radiation[0].radius_m - 4.0).abs() < 1e-9);
        let error = set.set("walls[0].doors.gate.open", "true").unwrap_err().to_string();
        assert!(
            error.ends_with("doors.gate.open is no field; there are at_m, width_m, name, closed"),
            "{error}"
        );
        let error = set.set("walls[0].doors[0].closd", "true").unwrap_err().to_string();
        assert!(error.ends_with("did you mean closed? There are at_m, width_m, name, closed"), "{error}");
        for value in ["{\"dt_s\": \"Uniform(0.01, 0.02)\"}", "1"] {
            let error = set.set("draws", value).unwrap_err().to_string();
            assert!(error.starts_with("draws is no field; there are format, name"), "{error}");
            assert!(error.ends_with("medium, deceit, words"), "{error}");
        }
    }

    #[test]
    fn what_cannot_be_set_is_named_and_nothing_changes() {
        let refused = |path: &str, value: &str| {
            let mut set = file();
            let error = set.set(path, value).unwrap_err().to_string();
            assert_eq!(set, file(), "{path}");
            error
        };
        assert_eq!(
            refused("costs.energy.per_stop", "1"),
            "costs.energy.per_stop is no field; did you mean per_step? There are per_step, per_metre, \
             per_second"
        );
        let error = refused("cots.energy", "1");
        assert!(
            error.contains("did you mean costs? a scenario has format, name, description, duration_s"),
            "{error}"
        );
        assert_eq!(
            refused("debris[7].at", "(1, 1)"),
            "debris[7].at is no field; debris has 2 entries, from [0] on"
        );
        assert!(refused("duration_s", "\"long\"").contains("found \"long\""));
        assert!(refused("conflicts.resolver", "Luck").contains("Rotation"));
        for value in ["1, dt_s: 1", "1) //", "1 /* ", "", "(1"] {
            assert!(refused("duration_s", value).starts_with("duration_s must be one value"), "{value}");
        }
    }
}
