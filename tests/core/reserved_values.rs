//! Values from which receivers conclude where a vehicle is for certain: what a stack sends before it is set up narrows no bound.

use holdover::model::bound::AccelerationRange;
use holdover::wire::driving_parameters::FIELDS;

#[test]
fn driving_parameters_of_a_stack_that_was_not_set_up_are_refused_or_say_less_than_none() {
    let worst = AccelerationRange::WORST;
    let least = [
        ("Length", 18_750),
        ("AccelerationLimit", i64::from(worst.acceleration.to_mm_per_s2())),
        ("EmergencyBraking", i64::from(worst.braking.to_mm_per_s2())),
    ];
    for (name, least_mm) in least {
        let field = FIELDS.iter().find(|field| field.name == name).expect("a field");
        assert!(field.min > 0, "{name}: 0 is reserved");
        let initial = field.initial.expect("a start value") * 1_000 / field.per_unit;
        assert!(initial >= least_mm, "{name}: {initial}");
    }
}
