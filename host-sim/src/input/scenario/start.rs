//! Possible starts of the vehicles, before anything is drawn: spans of positions enter; impossible spans are refused.

use super::{Span, Start, Vehicle};

/// Distances in the unit saturate at 2048 m.
const LONGEST_STRING_M: f64 = 2000.0;

/// An impossible start of a vehicle.
pub struct Misplaced {
    /// Its index.
    pub vehicle: usize,
    /// The cause.
    pub cause: String,
    /// The remedy.
    pub remedy: String,
}

/// The leader's position if the file gives none: as far along the lane as the string can be long. So the last vehicle
/// starts at 0 or beyond, whatever is drawn.
pub fn leader_position(vehicles: &[Vehicle]) -> f64 {
    let ahead = vehicles.iter().map(|vehicle| vehicle.length_m);
    let gaps = vehicles.iter().skip(1).map(|vehicle| match vehicle.start {
        Start::Gap(span) => span.high,
        Start::Position(_) => 0.0,
    });
    ahead.zip(gaps).map(|(length_m, gap_m)| length_m + gap_m).sum()
}

/// Checks that no vehicle can start inside the vehicle ahead, and that the last vehicle is within reach of the first.
pub fn check(vehicles: &[Vehicle]) -> Result<(), Misplaced> {
    let leader = vehicles.first().map(|leader| leader.start);
    let mut ahead: Option<Span> = None; // rear bumper of the vehicle ahead
    let mut front = Span { low: 0.0, high: 0.0 };
    for (index, vehicle) in vehicles.iter().enumerate() {
        let misplaced = |cause: String, remedy: &str| Misplaced { vehicle: index, cause, remedy: remedy.into() };
        let position = match (vehicle.start, ahead) {
            (Start::Position(_), Some(_)) if matches!(leader, Some(Start::Gap(_))) => {
                let cause = format!("vehicle {index} has a position and the leader (vehicle 0) has none");
                return Err(misplaced(cause, "give the leader `position_m` too, or this vehicle `gap_m`"));
            }
            (Start::Position(span), Some(rear)) if span.high >= rear.low => {
                let cause = format!(
                    "vehicle {index} can start at {} m, inside vehicle {}, whose rear bumper can be at {} m",
                    span.high,
                    index - 1,
                    rear.low
                );
                return Err(misplaced(cause, "list the vehicles from first to last, each behind the one before"));
            }
            (Start::Position(span), _) => span,
            (Start::Gap(gap), Some(rear)) => Span { low: rear.low - gap.high, high: rear.high - gap.low },
            (Start::Gap(_), None) => {
                let position_m = leader_position(vehicles);
                Span { low: position_m, high: position_m }
            }
        };
        if index == 0 {
            front = position;
        }
        if front.high - position.low > LONGEST_STRING_M {
            let cause = format!("vehicle {index} can start {} m behind the leader", front.high - position.low);
            return Err(misplaced(cause, "keep all vehicles within 2000 m"));
        }
        ahead = Some(Span { low: position.low - vehicle.length_m, high: position.high - vehicle.length_m });
    }
    Ok(())
}
