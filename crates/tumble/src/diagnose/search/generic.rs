//! Shapes that detect what the catalogue cannot explain. They are never used to name it.

use nalgebra::Vector3;

use super::before;
use super::family::{Family, Shape, Shapes, family, up};
use super::memory::{memory_of_force, memory_of_motion};
use crate::diagnose::catalogue::{AXES, G};
use crate::diagnose::twin::Twin;
use crate::diagnose::twin::data::Deed;
use crate::diagnose::twin::trajectory::Moment;

/// A family's name, and its shapes for a recording of this length (s), on the gyroscope or not.
type Group = (&'static str, fn(f64, bool) -> Shapes);

/// All families for a recording.
pub fn families(twin: &Twin) -> Vec<Family> {
    let end_s = twin.samples.last().map_or(1.0, |raw| raw.t_s).max(1.0);
    let groups: Vec<Group> = vec![
        ("specific force", |_, _| vector("f", |moment| moment.force / G)),
        ("products of forces", |_, _| pairs("f", |moment| moment.force / G)),
        ("cubes of forces", |_, _| cubes("f", |moment| moment.force / G)),
        ("rate", |_, _| vector("w", |moment| moment.rate)),
        ("products of rates", |_, _| pairs("w", |moment| moment.rate)),
        ("cubes of rates", |_, _| cubes("w", |moment| moment.rate)),
        ("size of the rate", |_, _| sizes()),
        ("angular acceleration", |_, _| vector("dw/dt", |moment| moment.acceleration)),
        ("force times rate", |_, _| mixed()),
        ("force times the rate's size", |_, _| vector("|w|*f", |moment| moment.force * (moment.rate.norm() / G))),
        ("time", trends),
        ("slow oscillation", |end_s, _| oscillations(end_s)),
        ("time since the last motion", |_, _| after_motion()),
        ("angle of the turn", |_, _| harmonics()),
        ("heading", |_, _| heading()),
        ("temperature", |_, _| temperature()),
    ];
    let mut families = Vec::new();
    for (name, shapes) in groups {
        for gyro in [true, false] {
            families.push(family(name, gyro, || shapes(end_s, gyro)));
        }
    }
    families.push(family("a field of the room", true, || heading().into_iter().chain(vector("up", up)).collect()));
    families.push(before::previous_face(twin));
    families.extend([true, false].map(|gyro| before::last_side(twin, gyro)));
    families.extend([true, false].map(|gyro| memory_of_motion(twin, gyro)));
    families.extend([true, false].map(|gyro| memory_of_force(twin, gyro)));
    families
}

fn vector(what: &'static str, value: fn(&Moment) -> Vector3<f64>) -> Shapes {
    (0..3).map(|i| (format!("{what}_{}", AXES[i]), Box::new(move |m: &Moment| value(m)[i]) as Shape)).collect()
}

fn pairs(what: &'static str, value: fn(&Moment) -> Vector3<f64>) -> Shapes {
    let pair = |(i, j): (usize, usize)| {
        let name = format!("{what}_{}*{what}_{}", AXES[i], AXES[j]);
        (name, Box::new(move |m: &Moment| value(m)[i] * value(m)[j]) as Shape)
    };
    [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)].into_iter().map(pair).collect()
}

fn cubes(what: &'static str, value: fn(&Moment) -> Vector3<f64>) -> Shapes {
    let cube = |i: usize| (format!("{what}_{}^3", AXES[i]), Box::new(move |m: &Moment| value(m)[i].powi(3)) as Shape);
    (0..3).map(cube).collect()
}

fn sizes() -> Shapes {
    let mut shapes: Shapes = (0..3)
        .map(|i| (format!("|w_{}|", AXES[i]), Box::new(move |m: &Moment| m.smooth_rate[i].abs()) as Shape))
        .collect();
    shapes.push(("|w|".into(), Box::new(|m: &Moment| m.rate.norm())));
    shapes.extend((0..3).map(|i| {
        (format!("sign(w_{})", AXES[i]), Box::new(move |m: &Moment| (m.smooth_rate[i] / 0.02).tanh()) as Shape)
    }));
    shapes
}

fn mixed() -> Shapes {
    let pair = |i: usize, j: usize| {
        let name = format!("f_{}*w_{}", AXES[i], AXES[j]);
        (name, Box::new(move |m: &Moment| m.force[i] / G * m.rate[j]) as Shape)
    };
    (0..3).flat_map(|i| (0..3).map(move |j| pair(i, j))).collect()
}

/// Of what each triad has a scale for.
fn trends(end_s: f64, gyro: bool) -> Shapes {
    let (letter, scaled): (_, fn(&Moment) -> Vector3<f64>) =
        if gyro { ("w", |moment| moment.rate) } else { ("f", |moment| moment.force / G) };
    let mut shapes: Shapes =
        (1..=3).map(|k| (format!("t^{k}"), Box::new(move |m: &Moment| (m.t_s / end_s).powi(k)) as Shape)).collect();
    shapes.extend((0..3).map(|i| {
        let drift = move |m: &Moment| (m.t_s / end_s - 0.5) * scaled(m)[i];
        (format!("t*{letter}_{}", AXES[i]), Box::new(drift) as Shape)
    }));
    shapes
}

fn oscillations(end_s: f64) -> Shapes {
    // One period in the recording to one in 5 s, each √2 of the last.
    let mut shapes: Shapes = Vec::new();
    let mut period_s = end_s;
    while period_s > 5.0 {
        let w = std::f64::consts::TAU / period_s;
        shapes.push((format!("sin(2 pi t/{period_s:.0} s)"), Box::new(move |m: &Moment| (w * m.t_s).sin())));
        shapes.push((format!("cos(2 pi t/{period_s:.0} s)"), Box::new(move |m: &Moment| (w * m.t_s).cos())));
        period_s /= std::f64::consts::SQRT_2;
    }
    shapes
}

fn after_motion() -> Shapes {
    [0.5, 2.0, 8.0]
        .into_iter()
        .map(|tau_s: f64| {
            let decays = move |m: &Moment| match m.deed {
                Deed::Rest { .. } => (-m.rested_s / tau_s).exp(),
                _ => 0.0,
            };
            (format!("exp(-rested/{tau_s} s)"), Box::new(decays) as Shape)
        })
        .collect()
}

fn harmonics() -> Shapes {
    [1.0, 2.0]
        .into_iter()
        .flat_map(|order: f64| {
            let turning = |m: &Moment| matches!(m.deed, Deed::Turn { .. });
            let sine = move |m: &Moment| if turning(m) { (order * m.turned_rad).sin() } else { 0.0 };
            let cosine = move |m: &Moment| if turning(m) { (order * m.turned_rad).cos() - 1.0 } else { 0.0 };
            [
                (format!("sin({order} angle)"), Box::new(sine) as Shape),
                (format!("cos({order} angle)"), Box::new(cosine) as Shape),
            ]
        })
        .collect()
}

/// A bias bends over temperature.
fn temperature() -> Shapes {
    vec![
        ("T".into(), Box::new(|moment: &Moment| moment.warmth_degc) as Shape),
        ("T^2".into(), Box::new(|moment: &Moment| moment.warmth_degc.powi(2)) as Shape),
    ]
}

fn heading() -> Shapes {
    vector("north", north).into_iter().chain(vector("east", east)).collect()
}

fn north(moment: &Moment) -> Vector3<f64> {
    moment.attitude.inverse_transform_vector(&Vector3::y())
}

fn east(moment: &Moment) -> Vector3<f64> {
    moment.attitude.inverse_transform_vector(&Vector3::x())
}
