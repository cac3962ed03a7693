//! The springs written again from their contract, in integers of any length.
//!
//! Every value is a whole number of a stated unit, every rounding a floor division of the exact number,
//! every root the search for a whole number. The state's unit is 2^-12 of a coordinate's last place.

use num_bigint::BigInt;
use num_traits::{One, Signed, ToPrimitive, Zero};

type Vector = [BigInt; 3];
type Ends = [BigInt; 2];

/// A spring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpringData {
    /// Its ends.
    pub ends: [usize; 2],
    /// Length at rest in units of `2^shift` of the state's.
    pub length: u32,
    /// See above.
    pub shift: u32,
    /// Factors of 16 bits: the first end's share, stretch, shape.
    pub factors: [u32; 3],
}

/// Springs over control points.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SpringsData {
    /// Mobility and anchor of each point, 16 bits.
    pub points: Vec<[u32; 2]>,
    /// The springs.
    pub springs: Vec<SpringData>,
    /// Substeps of a tick.
    pub substeps: u32,
    /// 16 bits.
    pub drag: u32,
    /// 16 bits.
    pub damping: u32,
    /// A push of one is `2^push_shift` of the state's units.
    pub push_shift: u32,
    /// In the state's units.
    pub gravity: [i64; 3],
}

/// What a point cannot enter; coordinates' bits, normals and grip with 16 fraction bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ObstacleData {
    /// Point, normal, grip.
    Plane([i32; 3], [i32; 3], u32),
    /// Centre, radius, grip.
    Sphere([i32; 3], u32, u32),
    /// Ends, radius, grip.
    Capsule([[i32; 3]; 2], u32, u32),
}

/// Position and velocity of a point.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Moving {
    /// Position.
    pub position: Vector,
    /// Velocity.
    pub velocity: Vector,
}

fn big(vector: [i32; 3]) -> Vector {
    vector.map(|value| BigInt::from(value) << 12)
}

fn zip(a: &Vector, b: &Vector, change: impl Fn(&BigInt, &BigInt) -> BigInt) -> Vector {
    [0, 1, 2].map(|axis| change(&a[axis], &b[axis]))
}

fn less(a: &Vector, b: &Vector) -> Vector {
    zip(a, b, |a, b| a - b)
}

fn dot(a: &Vector, b: &Vector) -> BigInt {
    (0..3).map(|axis| &a[axis] * &b[axis]).sum()
}

/// `floor(numerator / denominator + 1/2)` for a positive denominator.
fn quotient(numerator: &BigInt, denominator: &BigInt) -> BigInt {
    let doubled: BigInt = numerator * 2 + denominator;
    let divisor: BigInt = denominator * 2;
    let rest = ((&doubled % &divisor) + &divisor) % &divisor;
    (doubled - rest) / divisor
}

fn round(value: &BigInt, shift: u32) -> BigInt {
    quotient(value, &(BigInt::one() << shift))
}

fn scaled(vector: &Vector, factor: &BigInt) -> Vector {
    [0, 1, 2].map(|axis| round(&(&vector[axis] * factor), 16))
}

fn greatest(vector: &Vector) -> BigInt {
    vector.iter().map(Signed::abs).max().unwrap_or_default()
}

/// The least shift for which the greatest coordinate has 30 bits.
fn shift_of(vector: &Vector) -> u32 {
    let limit: BigInt = BigInt::one() << 30;
    (0..)
        .find(|&shift| greatest(vector) >> shift < limit)
        .unwrap_or_default()
}

fn shortened(vector: &Vector, shift: u32) -> Vector {
    vector.clone().map(|value| round(&value, shift))
}

/// The whole number nearest to the root of the sum of squares.
fn length_of(vector: &Vector) -> BigInt {
    let square = dot(vector, vector);
    let root = square.sqrt();
    // (root + 1/2)^2 = root^2 + root + 1/4.
    if &square - &root * &root > root {
        root + 1
    } else {
        root
    }
}

impl Moving {
    /// At rest at a place.
    #[must_use]
    pub fn at(place: [i32; 3]) -> Self {
        Self {
            position: big(place),
            velocity: [0, 1, 2].map(|_| BigInt::zero()),
        }
    }

    /// With this position and velocity.
    #[must_use]
    pub fn new(position: [i64; 3], velocity: [i64; 3]) -> Self {
        Self {
            position: position.map(BigInt::from),
            velocity: velocity.map(BigInt::from),
        }
    }

    /// The place, rounded to the coordinates' last place.
    #[must_use]
    pub fn place(&self) -> [i32; 3] {
        self.position
            .clone()
            .map(|value| round(&value, 12).to_i32().unwrap_or_default())
    }

    fn limit(&mut self) {
        let limit: BigInt = BigInt::one() << 43;
        for velocity in &mut self.velocity {
            *velocity = velocity.clone().clamp(-&limit, limit.clone());
        }
    }

    fn shift(&mut self, change: &Vector) -> u32 {
        let [least, most]: Ends = [i32::MIN, i32::MAX].map(|end| BigInt::from(end) << 12);
        let mut clamped = 0;
        for (axis, change) in change.iter().enumerate() {
            let wanted = &self.position[axis] + change;
            let place = wanted.clone().clamp(least.clone(), most.clone());
            clamped += u32::from(wanted != place);
            self.velocity[axis] += &place - &self.position[axis];
            self.position[axis] = place;
        }
        self.limit();
        clamped
    }
}

/// A rest length as a spring stores it: length and shift.
#[must_use]
pub fn rest_length(a: [i32; 3], b: [i32; 3]) -> (u32, u32) {
    let apart = less(&big(a), &big(b));
    let shift = shift_of(&apart);
    let length = length_of(&shortened(&apart, shift));
    (length.to_u32().unwrap_or_default(), shift)
}

impl SpringsData {
    /// One tick. Returns how many coordinates were clamped.
    pub fn tick(
        &self,
        goals: &[[i32; 3]],
        pushes: &[[i32; 3]],
        obstacles: &[ObstacleData],
        state: &mut [Moving],
    ) -> u32 {
        let mut clamped = 0;
        for step in 0..self.substeps {
            for (point, moving) in state.iter_mut().enumerate() {
                let push = pushes.get(point).copied().unwrap_or_default();
                let left = BigInt::from(self.substeps - step);
                clamped += self.advance(point, moving, goals[point], push, &left);
            }
            for spring in &self.springs {
                let change = spring.change(goals, state);
                clamped += spring.hand_out(&change, state, Moving::shift);
            }
            for (point, moving) in state.iter_mut().enumerate() {
                let [mobility, anchor] = self.points[point];
                if mobility != 0 {
                    let way = less(&big(goals[point]), &moving.position);
                    clamped += moving.shift(&scaled(&way, &anchor.into()));
                }
            }
            for (moving, data) in state.iter_mut().zip(&self.points) {
                if data[0] != 0 {
                    clamped += obstacles
                        .iter()
                        .map(|obstacle| touch(obstacle, moving))
                        .sum::<u32>();
                }
            }
            for spring in &self.springs {
                let [a, b] = spring.ends.map(|end| &state[end].velocity);
                let change = scaled(&less(a, b), &self.damping.into());
                spring.hand_out(&change, state, |moving, change| {
                    moving.velocity = zip(&moving.velocity, change, |a, b| a + b);
                    moving.limit();
                    0
                });
            }
        }
        clamped
    }

    fn advance(
        &self,
        point: usize,
        moving: &mut Moving,
        goal: [i32; 3],
        push: [i32; 3],
        left: &BigInt,
    ) -> u32 {
        let mobility = self.points[point][0];
        let mut before = std::mem::take(&mut moving.velocity);
        if mobility == 0 {
            let way = less(&big(goal), &moving.position);
            return moving.shift(&way.map(|way| quotient(&way, left)));
        }
        for (axis, velocity) in before.iter_mut().enumerate() {
            let loss = round(&(velocity.abs() * self.drag), 16).max(BigInt::one());
            let kept: BigInt = (velocity.abs() - loss).max(BigInt::zero());
            let push: BigInt = BigInt::from(push[axis]) << self.push_shift;
            *velocity =
                kept * velocity.signum() + self.gravity[axis] + round(&(push * mobility), 16);
        }
        let mut wanted = Moving {
            position: Vector::default(),
            velocity: before,
        };
        wanted.limit();
        moving.shift(&wanted.velocity)
    }
}

impl SpringData {
    /// What the difference of the ends loses.
    fn change(&self, goals: &[[i32; 3]], state: &[Moving]) -> Vector {
        let [a, b] = self.ends;
        let apart = less(&state[a].position, &state[b].position);
        let off = less(&apart, &less(&big(goals[a]), &big(goals[b])));
        let [_, stretch, shape] = self.factors.map(BigInt::from);
        let shift = shift_of(&apart);
        let short = shortened(&apart, shift);
        let length = length_of(&short);
        if length.is_zero() {
            return scaled(&off, &(stretch + shape));
        }
        let exact = BigInt::from(self.length) << self.shift;
        let rest = round(&exact, shift);
        let one: BigInt = BigInt::one() << 30;
        let ratio = quotient(&(&rest * &one), &length).min(&one * 2);
        [0, 1, 2].map(|axis| {
            let along: BigInt = (&short[axis] * (&one - &ratio)) << shift;
            round(&(&stretch * round(&along, 30) + &shape * &off[axis]), 16)
        })
    }

    /// Gives the first end its share of minus a change, the second the rest of it.
    fn hand_out(
        &self,
        change: &Vector,
        state: &mut [Moving],
        give: impl Fn(&mut Moving, &Vector) -> u32,
    ) -> u32 {
        let own = scaled(change, &self.factors[0].into());
        let [a, b] = self.ends;
        let first = give(&mut state[a], &own.clone().map(|value| -value));
        first + give(&mut state[b], &less(change, &own))
    }
}

/// Normal (16 bits) and depth, if a position is inside.
fn inside(obstacle: &ObstacleData, position: &Vector) -> Option<(Vector, BigInt)> {
    match *obstacle {
        ObstacleData::Plane(point, normal, _) => {
            let normal = normal.map(BigInt::from);
            let depth = -round(&dot(&normal, &less(position, &big(point))), 16);
            depth.is_positive().then_some((normal, depth))
        }
        ObstacleData::Sphere(centre, radius, _) => in_ball(position, &big(centre), radius),
        ObstacleData::Capsule(ends, radius, _) => {
            let [first, second] = ends.map(big);
            let along = less(&second, &first);
            let to = less(position, &first);
            let shift = shift_of(&along).max(shift_of(&to));
            let (along_short, to_short) = (shortened(&along, shift), shortened(&to, shift));
            let (part, whole) = (
                dot(&along_short, &to_short),
                dot(&along_short, &along_short),
            );
            let nearest = if !part.is_positive() {
                first
            } else if part >= whole {
                second
            } else {
                let excess = whole.bits().saturating_sub(46);
                let share = quotient(&((part >> excess) << 16), &(whole >> excess));
                zip(&first, &scaled(&along, &share), |a, b| a + b)
            };
            in_ball(position, &nearest, radius)
        }
    }
}

fn in_ball(position: &Vector, centre: &Vector, radius: u32) -> Option<(Vector, BigInt)> {
    let radius: BigInt = BigInt::from(radius) << 12;
    let from = less(position, centre);
    if greatest(&from) >= radius {
        return None;
    }
    let shift = shift_of(&[radius.clone(), BigInt::zero(), BigInt::zero()]);
    let (from, radius) = (shortened(&from, shift), round(&radius, shift));
    let distance = length_of(&from);
    if distance >= radius {
        return None;
    }
    let normal = if distance.is_zero() {
        [BigInt::zero(), BigInt::zero(), BigInt::from(1 << 16)]
    } else {
        from.map(|value| quotient(&(value << 16), &distance))
    };
    Some((normal, (radius - distance) << shift))
}

fn touch(obstacle: &ObstacleData, moving: &mut Moving) -> u32 {
    let (ObstacleData::Plane(.., grip)
    | ObstacleData::Sphere(.., grip)
    | ObstacleData::Capsule(.., grip)) = *obstacle;
    let Some((normal, depth)) = inside(obstacle, &moving.position) else {
        return 0;
    };
    let clamped = moving.shift(&scaled(&normal, &depth));
    let across = round(&dot(&normal, &moving.velocity), 16);
    let sliding = less(&moving.velocity, &scaled(&normal, &across));
    clamped + moving.shift(&scaled(&sliding, &grip.into()).map(|value| -value))
}
