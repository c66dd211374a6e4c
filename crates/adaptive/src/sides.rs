//! On which side each item of a pair stands: every item as often left as right, every pair in both orders.

/// Which item of a pair stands left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The first.
    First,
    /// The second.
    Second,
}

/// How often each pair was shown in each order.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Orders {
    items: usize,
    /// Times that the row's item stood left of the column's.
    left_of: Vec<usize>,
}

impl Orders {
    /// Nothing was shown yet.
    pub fn new(items: usize) -> Self {
        Self { items, left_of: vec![0; items * items] }
    }

    /// Counts a pair that was shown.
    ///
    /// # Panics
    /// For an item beyond them.
    pub fn count(&mut self, left: usize, right: usize) {
        self.left_of[left * self.items + right] += 1;
    }

    /// How much more often a stood left of b than b of a.
    fn excess(&self, a: usize, b: usize) -> i64 {
        let times = |a: usize, b: usize| self.left_of[a * self.items + b] as i64;
        times(a, b) - times(b, a)
    }

    /// How much more often an item stood left than right.
    fn lean(&self, item: usize) -> i64 {
        (0..self.items).map(|other| self.excess(item, other)).sum()
    }

    /// The side for a pair that is shown next, one at a time: the item that stood left less often goes left;
    /// of two alike the pair's rarer order, then the first item.
    pub fn next(&self, a: usize, b: usize) -> Side {
        if (self.lean(a), self.excess(a, b)) <= (self.lean(b), self.excess(b, a)) {
            Side::First
        } else {
            Side::Second
        }
    }
}

/// Sides of the pairs that one person is shown, each item left and right equally often, or once more on one
/// side where it is shown an odd number of times. The pairs are taken apart into cycles, items with an odd
/// number being joined by one more vertex, and each cycle is gone round one way (Euler): the way that evens
/// `orders` out, in which they are then counted.
///
/// # Panics
/// For an item beyond `items`.
pub fn sides(items: usize, pairs: &[(usize, usize)], orders: &mut Orders) -> Vec<Side> {
    let mut open = Graph::of(items, pairs);
    let mut given = vec![Side::First; pairs.len()];
    while let Some(cycle) = open.take_cycle() {
        let real = || cycle.iter().filter(|(edge, _)| *edge < pairs.len());
        // Gone round this way: for each pair, whether it is met from its first item.
        let excess: i64 = real()
            .map(|&(edge, from)| {
                let (a, b) = pairs[edge];
                if from == a { orders.excess(a, b) } else { orders.excess(b, a) }
            })
            .sum();
        for &(edge, from) in real() {
            let (a, b) = pairs[edge];
            let first = (from == a) == (excess <= 0);
            given[edge] = if first { Side::First } else { Side::Second };
            if first { orders.count(a, b) } else { orders.count(b, a) }
        }
    }
    given
}

/// Edges that are not used yet, at each vertex; every vertex has an even number.
struct Graph {
    /// For each vertex its edges with the other end.
    at: Vec<Vec<(usize, usize)>>,
    used: Vec<bool>,
}

impl Graph {
    /// The pairs, and edges from each item with an odd number of them to one more vertex.
    fn of(items: usize, pairs: &[(usize, usize)]) -> Self {
        let mut at = vec![Vec::new(); items + 1];
        let mut edges = 0;
        let mut join = |a: usize, b: usize| {
            at[a].push((edges, b));
            at[b].push((edges, a));
            edges += 1;
        };
        let mut odd = vec![false; items];
        for &(a, b) in pairs {
            join(a, b);
            odd[a] = !odd[a];
            odd[b] = !odd[b];
        }
        for item in (0..items).filter(|item| odd[*item]) {
            join(item, items);
        }
        Self { at, used: vec![false; edges] }
    }

    /// A cycle of unused edges, each with the vertex that it is left from; none where all are used.
    fn take_cycle(&mut self) -> Option<Vec<(usize, usize)>> {
        let start = (0..self.at.len()).find(|&vertex| self.unused(vertex).is_some())?;
        let mut path: Vec<(usize, usize)> = Vec::new();
        let mut vertex = start;
        loop {
            // Every vertex has an even number of edges, so that a walk can always leave where it came in.
            let (edge, other) = self.unused(vertex)?;
            self.used[edge] = true;
            path.push((edge, vertex));
            vertex = other;
            if let Some(first) = path.iter().position(|(_, from)| *from == vertex) {
                // What led there is for the next cycle.
                for &(edge, _) in &path[..first] {
                    self.used[edge] = false;
                }
                return Some(path.split_off(first));
            }
        }
    }

    fn unused(&self, vertex: usize) -> Option<(usize, usize)> {
        self.at[vertex].iter().copied().find(|(edge, _)| !self.used[*edge])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lean(items: usize, pairs: &[(usize, usize)], given: &[Side]) -> Vec<i64> {
        let mut lean = vec![0; items];
        for (&(a, b), side) in pairs.iter().zip(given) {
            let by = if *side == Side::First { 1 } else { -1 };
            lean[a] += by;
            lean[b] -= by;
        }
        lean
    }

    #[test]
    fn every_item_is_left_in_half_of_its_pairs() {
        let mut random = mimique_test_support::Random::new(11);
        for round in 0..200 {
            let items = 2 + round % 7;
            let draw = |random: &mut mimique_test_support::Random| {
                (random.uniform() * items as f64) as usize
            };
            let mut pairs = Vec::new();
            while pairs.len() < 25 {
                let (a, b) = (draw(&mut random), draw(&mut random));
                if a != b {
                    pairs.push((a, b));
                }
            }
            let given = sides(items, &pairs, &mut Orders::new(items));
            assert!(lean(items, &pairs, &given).iter().all(|lean| lean.abs() <= 1), "{pairs:?}");
        }
    }

    #[test]
    fn orders_are_evened_out_from_person_to_person() {
        let pairs: Vec<(usize, usize)> = crate::all_pairs(6);
        let mut orders = Orders::new(6);
        for _ in 0..20 {
            sides(6, &pairs, &mut orders);
        }
        for &(a, b) in &pairs {
            assert!(orders.excess(a, b).abs() <= 6, "{a} {b}: {}", orders.excess(a, b));
        }
        assert!((0..6).all(|item| orders.lean(item).abs() <= 20));
    }

    #[test]
    fn one_at_a_time_the_rarer_side_is_taken() {
        let mut orders = Orders::new(3);
        let mut next = |a: usize, b: usize| {
            let side = orders.next(a, b);
            if side == Side::First {
                orders.count(a, b)
            } else {
                orders.count(b, a)
            }
            side
        };
        assert_eq!(next(0, 1), Side::First);
        assert_eq!(next(0, 1), Side::Second);
        assert_eq!(next(0, 2), Side::First);
        assert_eq!(next(1, 0), Side::First, "0 has stood left once more than right");
    }
}
