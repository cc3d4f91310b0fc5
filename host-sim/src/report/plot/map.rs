//! A map with vehicles that move: lines and ways in metres enter; roads, areas and a dot for each vehicle leave. The dots
//! are where the vehicles are at one moment, and a script of the page plays their ways.

use std::fmt::Write;

use super::{
    Figure, Width,
    path::line,
    svg::{Area, Svg, pixel},
};

/// Room around the roads, and the radius of a vehicle, in pixels.
const MARGIN: f64 = 12.0;
const RADIUS: f64 = 5.0;

/// The highest map, in pixels.
const HIGHEST: f64 = 420.0;

/// A place, in metres to the right and up.
pub type Place = (f64, f64);

/// A vehicle on its way.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mover {
    /// Whether it is the vehicle under study.
    pub is_ego: bool,
    /// The time of the first place.
    pub from_s: f64,
    /// Its places, evenly in time.
    pub way: Vec<Place>,
}

/// Roads, areas and vehicles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Map {
    /// What the figure shows, for a screen reader.
    pub title: String,
    /// A description of what it shows, for a screen reader.
    pub description: String,
    /// The roads.
    pub roads: Vec<Vec<Place>>,
    /// Squares: the middle, and half the length of a side.
    pub areas: Vec<(Place, f64)>,
    /// The vehicles.
    pub movers: Vec<Mover>,
    /// Time between the places of a vehicle.
    pub every_s: f64,
    /// The time that can be played.
    pub span_s: (f64, f64),
    /// The moment that is shown.
    pub at_s: f64,
    /// When the vehicle under study is silent.
    pub silent_s: Option<(f64, f64)>,
}

impl Map {
    /// The corners of what there is.
    fn corners(&self) -> (Place, Place) {
        let start = ((f64::INFINITY, f64::INFINITY), (f64::NEG_INFINITY, f64::NEG_INFINITY));
        self.roads
            .iter()
            .flatten()
            .fold(start, |(low, high), &(x, y)| ((low.0.min(x), low.1.min(y)), (high.0.max(x), high.1.max(y))))
    }
}

impl Figure for Map {
    fn draw(&self, id: &str, width: Width) -> String {
        let mut svg = Svg::new(id);
        let pixels = width.pixels();
        let (low, high) = self.corners();
        let (wide_m, high_m) = ((high.0 - low.0).max(1.0), (high.1 - low.1).max(1.0));
        let scale = ((pixels - 2.0 * MARGIN) / wide_m).min((HIGHEST - 2.0 * MARGIN) / high_m);
        let height = high_m * scale + 2.0 * MARGIN;
        let left = (pixels - wide_m * scale) / 2.0;
        let place = |&(x, y): &Place| (left + (x - low.0) * scale, height - MARGIN - (y - low.1) * scale);
        for road in &self.roads {
            svg.path("road", &line(road.iter().map(|at| Some(place(at)))));
        }
        for (middle, half_m) in &self.areas {
            let ((x, y), half) = (place(middle), (half_m * scale).max(RADIUS));
            svg.rectangle("area", Area { left: x - half, top: y - half, right: x + half, bottom: y + half });
        }
        // The vehicle under study lies above all others.
        let (egos, others): (Vec<&Mover>, Vec<&Mover>) = self.movers.iter().partition(|mover| mover.is_ego);
        for mover in others.into_iter().chain(egos) {
            let way = mover.way.iter().map(place);
            let spelled = way.clone().fold(String::new(), |mut text, (x, y)| {
                let _ = write!(text, "{}{},{}", if text.is_empty() { "" } else { " " }, pixel(x), pixel(y));
                text
            });
            let index = (self.at_s - mover.from_s) / self.every_s;
            let shown = (index >= 0.0).then(|| way.clone().nth(index.round() as usize)).flatten();
            let is_silent = mover.is_ego && self.silent_s.is_some_and(|(from, to)| (from..to).contains(&self.at_s));
            let class = match (mover.is_ego, is_silent) {
                (false, _) => "car",
                (true, false) => "car ego",
                (true, true) => "car ego silent",
            };
            let radius = if mover.is_ego { RADIUS + 1.0 } else { RADIUS };
            svg.mover(class, shown, radius, mover.from_s, &spelled);
        }
        let silent = self.silent_s.map_or(String::new(), |(from, to)| format!(" data-silent=\"{from:.2} {to:.2}\""));
        let (from, to) = self.span_s;
        let attributes =
            format!(" class=\"map\" data-span=\"{from:.2} {to:.2} {:.2} {}\"{silent}", self.at_s, self.every_s);
        svg.finish(pixels, height, &self.title, &self.description).replacen("<svg ", &format!("<svg{attributes} "), 1)
    }

    fn undrawable(&self) -> usize {
        let places = self.movers.iter().flat_map(|mover| &mover.way);
        places.filter(|(x, y)| !x.is_finite() || !y.is_finite()).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vehicle_is_drawn_where_it_is_at_that_moment_and_nowhere_before_it_comes() {
        let mover = |from_s, is_ego| Mover { is_ego, from_s, way: vec![(0.0, 0.0), (50.0, 0.0), (100.0, 0.0)] };
        let map = Map {
            roads: vec![vec![(0.0, 0.0), (100.0, 0.0)]],
            movers: vec![mover(0.0, true), mover(9.0, false)],
            every_s: 1.0,
            span_s: (0.0, 9.0),
            at_s: 1.0,
            silent_s: Some((0.5, 2.0)),
            ..Map::default()
        };
        let drawn = map.draw("m", Width::Narrow);
        assert!(drawn.contains(r#"class="car ego silent" cx="190""#), "{drawn}");
        assert!(drawn.contains(r#"<circle class="car" style="display:none""#), "{drawn}");
        assert!(drawn.contains(r#"data-way="12,15.6 190,15.6 368,15.6""#), "{drawn}");
    }
}
