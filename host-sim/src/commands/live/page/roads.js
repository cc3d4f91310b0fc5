// The roads of a corridor: a road and a distance along it enter; the place leaves, in metres to the east and to the north, and the
// direction there, in radians from north to the east.

export function roads(cast) {
  const pieces = cast.roads.map((road) =>
    road.points.slice(1).map(([toM, east, north], index) => {
      const [fromM, e, n] = road.points[index];
      return { fromM, toM, e, n, along: [(east - e) / (toM - fromM), (north - n) / (toM - fromM)] };
    }));
  const at = (road, wayM) => {
    const piece = pieces[road].find((one) => wayM < one.toM) ?? pieces[road].at(-1);
    const m = wayM - piece.fromM;
    return [piece.e + piece.along[0] * m, piece.n + piece.along[1] * m, Math.atan2(piece.along[0], piece.along[1])];
  };
  const middle = (square) => {
    const places = square.legs.map(([road, wayM]) => at(road, wayM));
    return [0, 1].map((axis) => places.reduce((sum, place) => sum + place[axis], 0) / places.length);
  };
  return { at, pieces, middles: cast.intersections.map(middle) };
}
