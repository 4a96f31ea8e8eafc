//! What a face that stays on the table tells: the plate, and stops after whole turns.

use nalgebra::Vector3;
use std::f64::consts::PI;
use tumble_core::face::Face;
use tumble_core::motion::path::{NUDGE, WHOLE_TURN};
use tumble_core::tape::Kind;

use super::Setting;
use super::unknowns::{Rest, Unknowns};
use crate::reference::solve::Block;

/// A stay on one face.
struct Visit {
    face: Face,
    facet: Option<usize>,
    first: Rest,
    stop: usize,
    turned_rad: f64,
}

/// Blocks of all visits, and of each rest the unknowns of its face's error; the bookkeeping is the device's (`walk.rs`).
pub(super) fn visits<'a>(
    setting: &Setting<'a>,
    unknowns: &mut Unknowns,
    rests: &[Rest],
) -> (Vec<Block<'a>>, Vec<Option<usize>>) {
    let (mut blocks, mut facets) = (Vec::new(), Vec::new());
    let mut visit: Option<Visit> = None;
    let mut next = rests.iter().peekable();
    for (index, stretch) in setting.stretches.iter().enumerate() {
        if let Some(rest) = next.next_if(|rest| rest.stretch == index) {
            visit = stretch.face.map(|face| {
                let kept = visit.take().filter(|visit| visit.face == face);
                rested(setting, unknowns, *rest, face, kept, &mut blocks)
            });
            facets.push(visit.as_ref().and_then(|visit| visit.facet));
        } else if let (Kind::OnTable { angle_rad, .. }, true) = (stretch.segment.kind, stretch.is_turn()) {
            visit.iter_mut().for_each(|visit| visit.turned_rad += f64::from(angle_rad));
        } else {
            visit = None;
        }
    }
    (blocks, facets)
}

fn rested<'a>(
    setting: &Setting<'a>,
    unknowns: &mut Unknowns,
    rest: Rest,
    face: Face,
    kept: Option<Visit>,
    blocks: &mut Vec<Block<'a>>,
) -> Visit {
    let sigma = f64::from(setting.noise.stop_sigma_rad);
    let facet = match &kept {
        Some(visit) => visit.facet,
        None => setting.noise.facet_sigma_rad.map(|sigma| unknowns.add_with_prior(2, f64::from(sigma))),
    };
    let contact = f64::from(setting.noise.contact_sigma_rad);
    blocks.extend(facet.map(|facet| plate(rest, face, facet, contact)));
    if let Some(mut visit) = kept {
        let turned = visit.turned_rad.abs();
        if turned > PI && left(&unknowns.x, rest, visit.first, face).abs() < f64::from(WHOLE_TURN) {
            visit.turned_rad = 0.0;
            blocks.push(closure(rest, visit.first, face, visit.stop, sigma));
        }
        if turned > f64::from(NUDGE) {
            return visit;
        }
    }
    Visit { face, facet, first: rest, stop: unknowns.add_with_prior(1, sigma), turned_rad: 0.0 }
}

/// `(R (n + e))ₓᵧ = p`.
fn plate<'a>(rest: Rest, face: Face, facet: usize, contact: f64) -> Block<'a> {
    let depends = rest.all().take(3).chain(facet..facet + 2).chain(rest.table..rest.table + 2);
    Block::new(depends, move |x| {
        let mut normal: Vector3<f64> = face.normal().cast();
        normal[(face.axis() + 1) % 3] += x[facet];
        normal[(face.axis() + 2) % 3] += x[facet + 1];
        let normal = rest.rotation(x) * normal;
        (0..2).map(|axis| (normal[axis] - x[rest.table + axis]) / contact).collect()
    })
}

fn closure<'a>(rest: Rest, first: Rest, face: Face, stop: usize, sigma: f64) -> Block<'a> {
    let depends = rest.all().take(3).chain(first.all().take(3)).chain([stop]);
    Block::new(depends, move |x| vec![(left(x, rest, first, face) - x[stop]) / sigma])
}

/// What is left after whole turns about the table's normal, rad.
fn left(x: &[f64], rest: Rest, first: Rest, face: Face) -> f64 {
    let (now, before) = (rest.rotation(x), first.rotation(x));
    (now * before.inverse()).scaled_axis().dot(&(now * face.normal().cast::<f64>()))
}
