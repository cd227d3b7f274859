//! Setting one field of a scenario by its path.

use ron_fields::{Fields, SetError};

use super::{Problem, ScenarioFile, draws};

impl ScenarioFile {
    /// Sets the field at a path such as `costs.energy.per_step` or `tasks.village.grid[0]` to a value in RON.
    /// Does not check the rules: they are checked when the file becomes a scenario.
    ///
    /// # Errors
    /// There is no such field, or the value is not of its type.
    pub fn set(&mut self, path: &str, value: &str) -> Result<(), SetError> {
        let wrapped = format!("[{value}]");
        let is_plain = !super::distribution::WORDS.iter().any(|word| value.contains(word));
        if self.draws.is_empty() && is_plain {
            *self = ron_fields::set(self, path, value, "a scenario")?;
            return Ok(());
        }
        let text = ron::to_string(&self.without_draws()).unwrap_or_default();
        let canonical = Fields::of(&text).canonical(path).unwrap_or_else(|| path.to_owned());
        let (plain, draws, wrong) = draws::take_out(&wrapped, &Fields::of(&wrapped), &canonical);
        if let Some(Problem { rule: reason, found, .. }) = wrong.into_iter().next() {
            return Err(SetError::Malformed { path: path.to_owned(), reason, found });
        }
        let inner = if draws.is_empty() { value } else { plain[1..plain.len() - 1].trim_end() };
        let mut set = ron_fields::set(&self.without_draws(), path, inner, "a scenario")?;
        set.draws.clone_from(&self.draws);
        let is_inside = |key: &str| {
            key.strip_prefix(canonical.as_str())
                .is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
        };
        set.draws.retain(|key, _| !is_inside(key));
        set.draws.extend(draws);
        *self = set;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{Amount, DebrisShape, ron_options};

    fn file() -> ScenarioFile {
        let row = "(role: \"robot\", count: 2, center: (5, 5), width_m: 2)";
        let debris = "(shape: Box(1, 2), at: (8, 8)), (shape: Disc(0.5), at: (3, 3))";
        let text = format!(
            "(name: \"t\", duration_s: 60, dt_s: 0.02, arena_m: (20, 20), team: [{row}], debris: [{debris}])"
        );
        ron_options().from_str(&text).unwrap()
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
            Some(crate::scenario::Levels { energy: Amount::Fixed(50.0), hp: Amount::Fixed(60.0) });
        expected.arena_m[1] = 30.0;
        assert_eq!(set, expected);
    }

    #[test]
    fn doors_and_sources_are_found_by_their_names() {
        let door = "(at_m: 3, width_m: 2), (at_m: 9, width_m: 2, name: \"gate\")";
        let mut set: ScenarioFile = ron_options()
            .from_str(&format!(
                "(name: \"t\", duration_s: 60, dt_s: 0.02, arena_m: (20, 20), team: [], radiation: [(at: (1, 1), \
                 radius_m: 2, name: \"leak\")], walls: [(from: (0, 9), to: (20, 9), doors: [{door}])])"
            ))
            .unwrap();
        set.set("walls[0].doors.gate.width_m", "3").unwrap();
        set.set("walls[0].doors.gate.closed", "true").unwrap();
        set.set("walls[0].doors[0].name", "\"left\"").unwrap();
        set.set("radiation.leak.radius_m", "4").unwrap();
        let [left, gate] = &set.walls[0].doors[..] else { panic!("two doors") };
        assert_eq!((left.name.as_deref(), left.is_closed), (Some("left"), false));
        assert_eq!((gate.width_m, gate.is_closed), (3.0, true));
        assert!((set.radiation[0].radius_m - 4.0).abs() < 1e-9);
        let error = set.set("walls[0].doors.gate.open", "true").unwrap_err().to_string();
        assert!(error.contains("walls[0].doors.gate has at_m, width_m, name, closed"), "{error}");
        let error = set.set("walls[0].doors[0].closd", "true").unwrap_err().to_string();
        assert!(error.ends_with("did you mean closed?"), "{error}");
        for value in ["{\"dt_s\": \"Uniform(0.01, 0.02)\"}", "1"] {
            let error = set.set("draws", value).unwrap_err().to_string();
            assert!(error.starts_with("draws: no such field; a scenario has format, name"), "{error}");
            assert!(error.ends_with("planning, conflicts"), "{error}");
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
            "costs.energy.per_stop: no such field; costs.energy has per_step, per_metre, per_second; did you \
             mean per_step?"
        );
        assert!(refused("cots.energy", "1").contains("a scenario has format, name, description, duration_s"));
        assert_eq!(
            refused("debris[7].at", "(1, 1)"),
            "debris[7].at: no such field; debris has 2 entries, from [0] on"
        );
        assert!(refused("duration_s", "\"long\"").contains("found \"long\""));
        assert!(refused("conflicts.resolver", "Luck").contains("Rotation"));
        for value in ["1, dt_s: 1", "1) //", "1 /* ", "", "(1"] {
            assert!(refused("duration_s", value).starts_with("duration_s: "), "{value}");
        }
    }
}
