//! The end of a task: its group has no more work and goes home.

use rne_core::TaskId;

use super::{Activity, Mission};

impl Mission {
    /// Takes away the work of a group. The group then goes home, because nothing is left to do.
    pub(crate) fn withdraw(&mut self, task: TaskId) {
        for id in self.groups[task.index()].members.clone() {
            self.release_claim(id);
            let agent = self.agent(id);
            if agent.activity.is_in_field() {
                agent.sweep.clear();
                agent.activity = Activity::Standby;
            }
        }
    }
}
