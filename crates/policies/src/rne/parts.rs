//! Parts of a role, and the orders of their sizes.

/// A partition of a role, with the results of the search. Parts are in the order of their smallest members;
/// empty parts come last.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Partition {
    /// For each part, indices into the role's rows, ascending.
    pub(super) parts: Vec<Vec<usize>>,
    /// The next best partition that was searched, and its score.
    pub(super) runner_up: Option<(Vec<Vec<usize>>, f64)>,
    pub(super) searched: u64,
    pub(super) proven_optimal: bool,
}

/// All distinct orders of these sizes, in lexicographic order. The sizes must be in ascending order.
pub(super) fn distinct_orders(sizes: &[usize]) -> Vec<Vec<usize>> {
    if sizes.is_empty() {
        return vec![Vec::new()];
    }
    let mut orders = Vec::new();
    for (place, size) in sizes.iter().enumerate() {
        if place > 0 && sizes[place - 1] == *size {
            continue;
        }
        let rest = [&sizes[..place], &sizes[place + 1..]].concat();
        orders.extend(distinct_orders(&rest).into_iter().map(|order| [vec![*size], order].concat()));
    }
    orders
}

/// Members of each part, ascending; parts in the order of their smallest members.
pub(super) fn in_order(part_of: &[usize], parts: usize) -> Vec<Vec<usize>> {
    let mut members = vec![Vec::new(); parts];
    part_of.iter().enumerate().for_each(|(i, part)| members[*part].push(i));
    members.sort_by_key(|part| part.first().copied().unwrap_or(usize::MAX));
    members
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_of_sizes_are_distinct() {
        assert_eq!(distinct_orders(&[1, 1, 2]), [[1, 1, 2], [1, 2, 1], [2, 1, 1]]);
        assert_eq!(distinct_orders(&[2, 2]), [[2, 2]]);
    }
}
