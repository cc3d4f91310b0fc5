//! Polynomials with integer coefficients, for tests: an identity that holds between two of them holds for all values of their
//! variables, which is how a claim is proved over a whole range and not at points. Variables enter; the one normal form of
//! what was computed with them leaves.

use std::collections::BTreeMap;
use std::ops::{Add, Mul, Sub};

/// Most variables of a proof.
pub const VARIABLES: usize = 16;

/// What a formula is written over: numbers, when it is compared with the code, or polynomials, when it is proved.
pub trait Ring: Clone + From<i64> + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}

impl<T: Clone + From<i64> + Add<Output = T> + Sub<Output = T> + Mul<Output = T>> Ring for T {}

/// A sum of products of variables: the coefficient of each product of powers, none of them 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Polynomial(BTreeMap<[u8; VARIABLES], i128>);

impl Polynomial {
    /// The variables, each by itself.
    pub fn variables<const N: usize>() -> [Self; N] {
        std::array::from_fn(|index| {
            let mut powers = [0; VARIABLES];
            powers[index] = 1;
            Self(BTreeMap::from([(powers, 1)]))
        })
    }

    /// Whether it is 0 for all values.
    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether it can be seen not to be negative for values that are not: it has no negative coefficient.
    pub fn is_plainly_not_negative(&self) -> bool {
        self.0.values().all(|coefficient| *coefficient >= 0)
    }

    fn with(mut self, powers: [u8; VARIABLES], coefficient: i128) -> Self {
        let sum = self.0.remove(&powers).unwrap_or(0) + coefficient;
        if sum != 0 {
            self.0.insert(powers, sum);
        }
        self
    }
}

impl From<i64> for Polynomial {
    fn from(number: i64) -> Self {
        Self(BTreeMap::new()).with([0; VARIABLES], number.into())
    }
}

impl Add for Polynomial {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        other.0.into_iter().fold(self, |sum, (powers, coefficient)| sum.with(powers, coefficient))
    }
}

impl Sub for Polynomial {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        other.0.into_iter().fold(self, |sum, (powers, coefficient)| sum.with(powers, -coefficient))
    }
}

impl Mul for Polynomial {
    type Output = Self;

    #[allow(clippy::suspicious_arithmetic_impl)] // a product's powers are sums
    fn mul(self, other: Self) -> Self {
        let mut product = Self::from(0);
        for (a, x) in &self.0 {
            for (b, y) in &other.0 {
                product = product.with(std::array::from_fn(|index| a[index] + b[index]), x * y);
            }
        }
        product
    }
}

/// A proof of `claim >= 0`: premises that are 0, each with the factor that it enters by, and what is left, which is not
/// negative.
pub struct Certificate<R> {
    /// What is to be shown not to be negative.
    pub claim: R,
    /// Factor and premise; every premise is 0 by the definition of what the code computes.
    pub premises: Vec<(R, R)>,
    /// What the claim comes to: products of what is not negative.
    pub rest: R,
}

impl Certificate<Polynomial> {
    /// The claim is the rest and multiples of the premises, identically, and the rest is plainly not negative.
    pub fn holds(self) -> bool {
        let used = self.premises.into_iter().fold(Polynomial::from(0), |sum, (factor, premise)| sum + factor * premise);
        self.rest.is_plainly_not_negative() && (self.claim - used - self.rest).is_zero()
    }
}

impl Certificate<i128> {
    /// Whether it is about these numbers: the premises are 0.
    pub fn applies(&self) -> bool {
        self.premises.iter().all(|(_, premise)| *premise == 0)
    }
}

#[test]
fn an_identity_is_told_from_what_is_none() {
    let [x, y] = Polynomial::variables();
    let square = |a: Polynomial| a.clone() * a;
    let number = Polynomial::from;
    let left = square(x.clone() + y.clone()) - square(x.clone() - y.clone());
    assert!((left.clone() - number(4) * x.clone() * y.clone()).is_zero());
    assert!(!(left.clone() - number(4) * x.clone()).is_zero());
    assert!(left.is_plainly_not_negative() && !(x - y).is_plainly_not_negative());
}
