//! Binding quotas. Groups are formed before they get their tasks, so their sizes must fit the tasks in some
//! order.

use super::group::Group;
use teaming::ids::{RoleId, TaskId};
use teaming::question::Question;

/// The sizes that the groups must have, role by role, if quotas bind.
pub(super) struct Sizes {
    /// Role of each member of the team.
    role_of: Vec<RoleId>,
    /// For each task, the number of members of each binding role, in the order of `binding`.
    wanted: Vec<Vec<usize>>,
    /// The roles whose quotas bind.
    binding: Vec<RoleId>,
}

impl Sizes {
    pub(super) fn of(question: &Question) -> Self {
        let binds = |role: &RoleId| question.quotas[role.index()].binds();
        let binding: Vec<RoleId> = question.role_ids().filter(binds).collect();
        let quota = |role: &RoleId, task: TaskId| question.quotas[role.index()].members[task.index()];
        let of_task = |task: TaskId| binding.iter().map(|role| quota(role, task)).collect();
        let wanted = question.task_ids().map(of_task).collect();
        Self { role_of: question.members.iter().map(|member| member.role).collect(), wanted, binding }
    }

    /// How many of these members belong to each binding role, in the order of `binding`.
    fn sizes(&self, members: &[usize]) -> Vec<usize> {
        let of_role = |role: &RoleId| members.iter().filter(|i| self.role_of[**i] == *role).count();
        self.binding.iter().map(of_role).collect()
    }

    /// The indices in `binding` of the roles of which some of these groups have members: the roles merged so
    /// far.
    fn looked_at(&self, groups: &[Vec<usize>]) -> Vec<usize> {
        let all: Vec<usize> = groups.iter().flat_map(|sizes| sizes.iter().enumerate()).fold(
            vec![0; self.binding.len()],
            |mut all, (place, size)| {
                all[place] += size;
                all
            },
        );
        (0..all.len()).filter(|place| all[*place] > 0).collect()
    }

    /// A different task for each of the groups of these sizes; `None` if the sizes do not fit.
    fn tasks_for(&self, groups: &[Vec<usize>]) -> Option<Vec<usize>> {
        let looked_at = self.looked_at(groups);
        let mut taken = vec![false; self.wanted.len()];
        let fits = |group: &Vec<usize>, task: usize| {
            looked_at.iter().all(|place| group[*place] == self.wanted[task][*place])
        };
        let mut tasks = Vec::with_capacity(groups.len());
        for group in groups {
            let task = (0..taken.len()).find(|task| !taken[*task] && fits(group, *task))?;
            taken[task] = true;
            tasks.push(task);
        }
        Some(tasks)
    }

    /// Whether a matching gives groups whose sizes fit the tasks in some order.
    pub(super) fn admit(&self, groups: &[Group], parts: &[Group], matching: &[usize]) -> bool {
        if self.binding.is_empty() {
            return true;
        }
        let joined = |(group, part): (&Group, &usize)| {
            let both = [group.members.as_slice(), &parts[*part].members].concat();
            self.sizes(&both)
        };
        let sizes: Vec<Vec<usize>> = groups.iter().zip(matching).map(joined).collect();
        self.tasks_for(&sizes).is_some()
    }

    /// An admissible matching: the identity if it is admissible, as it is if no quota binds.
    pub(super) fn start(&self, groups: &[Group], parts: &[Group]) -> Vec<usize> {
        let identity: Vec<usize> = (0..groups.len()).collect();
        if self.admit(groups, parts, &identity) {
            return identity;
        }
        let tasks = |list: &[Group]| {
            let sizes: Vec<Vec<usize>> = list.iter().map(|group| self.sizes(&group.members)).collect();
            self.tasks_for(&sizes)
        };
        match (tasks(groups), tasks(parts)) {
            (Some(of_groups), Some(of_parts)) => {
                let part = |task: &usize| of_parts.iter().position(|other| other == task).unwrap_or(0);
                of_groups.iter().map(part).collect()
            }
            _ => identity,
        }
    }

    /// Whether a group may take a task.
    pub(super) fn allows(&self, group: &Group, task: TaskId) -> bool {
        self.sizes(&group.members) == self.wanted[task.index()]
    }
}
