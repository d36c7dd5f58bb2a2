// One impact of a sphere on a plate: the functions of contactlaw.h.in, in JavaScript. `pair` has
// the law's array and the numbers of the materials, for R = 1 m and H = 1 m. What is in capitals
// and not defined here is a constant of the Python package.
const { plate } = pair, { corrections, growth } = plate;
let [now] = pair.nodes, { law } = now; // at the strength that is asked for, see `atRate`

function polynomial(at, degree, t) {
  let value = 0;
  for (let n = degree; n >= 0; --n) value = value * t + law[at + n];
  return value;
}
function below(at, most, x) { // number of ascending starts of pieces that are not above x
  let count = 0;
  while (count < most && x >= law[at + count]) ++count;
  return count;
}
const rowAt = (q) => law[CURVE] + Math.max(below(law[STARTS], law[PIECES], q) - 1, 0) * PIECE;
function loading(q, row = rowAt(q)) {
  return polynomial(law[row + AT], law[row + DEGREE], law[row + SCALE] * q - law[row + OFFSET]);
}
function unloadingRow(dm) { // 0 where the contact is elastic
  const at = law[FAMILY_STARTS], count = below(at, law[UNLOADINGS], dm);
  return dm > law[at] && count > 0 ? law[FAMILY] + (count - 1) * UNLOADING_ROW : 0;
}
function valueAt(row, which, dm) {
  const entry = row + OFFSET + 1 + which * FUNCTION, t = law[row + SCALE] * dm - law[row + OFFSET];
  return polynomial(law[entry + FUNCTION_AT], law[entry + FUNCTION_DEGREE], t)
    * (dm - 1) ** law[entry + FUNCTION_POWER];
}
function unloading(dm) { // the curve down from a largest compression; capped from low to high
  const row = unloadingRow(dm), capped = row > 0 && law[CAPPED] > 0;
  if (row === 0) return { residual: 0, stiffness: 0, exponent: 3, low: 0, high: 0 };
  const residual = valueAt(row, RESIDUAL, dm), exponent = valueAt(row, EXPONENT, dm);
  const stiffness = loading(Math.sqrt(dm)) / (dm - residual) ** (0.5 * exponent);
  const low = capped ? Math.max(valueAt(row, CAP_LOW, dm), residual) : 0;
  return { residual, stiffness, exponent, low, high: capped ? valueAt(row, CAP_HIGH, dm) : 0 };
}
function forceOn(curve, q) { // at the compression residual + q^2; while loading there is no curve
  if (!curve || curve.stiffness === 0) return loading(q);
  const f = curve.stiffness * Math.sign(q) * Math.abs(q) ** curve.exponent;
  const d = curve.residual + q * q;
  return curve.low < d && d < curve.high ? Math.min(f, loading(Math.sqrt(d))) : f;
}

const lengthening = (lam) => 1 + LENGTHENING * lam + LENGTHENING_3 * lam ** 3;
function nearField(h) { // factor on the mobility of a thin plate, less that of the half-space
  const x = h * corrections.steepest, { p1, p2, p3, p4, p5 } = corrections;
  return x < 1 ? (1 - x) ** 3 * (1 + x * (p1 + x * (p2 + x * (p3 + x * (p4 + x * p5))))) : 0;
}
function numbersOf(speed, radius, thickness) { // contactlaw.equation.numbers
  const ratio = radius / thickness, mass = pair.mass * radius ** 3;
  const base = (mass / (pair.stiffness * Math.sqrt(radius))) ** 0.4, rigid = speed ** 0.2;
  const shorter = growth.log_time - Math.log(base / rigid), grown = growth.modulus_power * shorter;
  const slower = Math.exp(-0.5 * growth.plate_power * shorter);
  const root = rigid * Math.exp(0.4 * grown), reach = plate.x_at_one * Math.exp(-grown);
  const perRoot = plate.inelasticity * slower, transit = plate.transit * slower;
  let lam = perRoot * root * ratio ** 2, stiffer = 1;
  if (corrections.bulk_factor > 0) {
    const slow = Math.min(root, now.saturated), x = reach * slow ** 2;
    const usual = H_0 * lengthening(Math.min(lam, LONGEST)) ** 2;
    const g = 1 - 2 * usual / (transit * root / ratio + usual);
    const first = (corrections.eta + corrections.eta_h * g) * Math.min(x, DEEPEST, BROADEST / ratio);
    stiffer = Math.exp(ratio * (first + corrections.eta4 * Math.min(x, WIDEST) ** 4));
    const fast = root * stiffer, thin = perRoot * fast * ratio ** 2, h = transit * fast / ratio;
    const longer = 1 / lengthening(thin * nearField(h));
    lam = thin * nearField(h * longer)
      + corrections.bulk_factor * perRoot * fast * (transit * fast * longer) ** 2
      + corrections.plastic_growth * ratio * reach * (root ** 2 - slow ** 2);
    lam *= Math.exp(growth.wave + growth.wave_slope * Math.min(lam, 1));
  }
  const scale = now.scale * radius * Math.exp(growth.yield_power * grown);
  return { lam, scale, mass, time: base / (root * stiffer) };
}

// A point of the contact on Hertz's scale: root compression above the residual one, speed of the
// sphere, time, integral of the squared force; all are smooth in s, dt = 2 q ds.
function rates(run, at, to) {
  const q = at[0], f = run.force * forceOn(run.curve, run.root * q);
  [to[0], to[1], to[2], to[3]] = [at[1] - run.lam * f, -2 * q * f, 2 * q, 2 * q * f * f];
}
function nextKink({ curve, root }, q) { // where the force has a kink, or the contact ends
  const residual = curve ? curve.residual : 0, d = residual + (root * q) ** 2;
  const row = rowAt(Math.sqrt(d) * (curve ? 1 - 1e-12 : 1 + 1e-12)), past = d * (1 - 2e-12);
  const start = (k) => law[law[STARTS] + law[row + k]];
  if (!curve) return start(NEXT) / root;
  const { stiffness, low, high } = curve;
  if (stiffness > 0 && high > low && past > high) return Math.sqrt(high - residual) / root;
  if (stiffness > 0 && !(high > low && past > low)) return 0;
  return Math.sqrt(Math.max(start(FIRST) ** 2, low) - residual) / root;
}
const DORMAND_PRINCE = [
  [1 / 5], [3 / 40, 9 / 40], [44 / 45, -56 / 15, 32 / 9],
  [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729],
  [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656],
  [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
  [71 / 57600, 0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40]]; // of the error
function advance(run, h, at, rate, to) { // a step; gives the larger error of q and u
  let error = 0;
  for (let n = 0; n < 7; ++n) {
    for (let k = 0; k < 4; ++k) {
      let sum = 0;
      for (let j = 0; j <= n; ++j) sum += DORMAND_PRINCE[n][j] * rate[j][k];
      if (n < 6) to[k] = at[k] + h * sum;
      else if (k < 2) error = Math.max(error, Math.abs(h * sum));
    }
    if (n < 6) rates(run, to, rate[n + 1]);
  }
  return error;
}
// Load to the largest compression, or unload to separation, and note the points of the path. If the
// sphere could leave with no more than the restitution `least` were the plate fixed, it does that.
function integrate(run, at, rtol, least) {
  const rate = Array.from({ length: 7 }, () => new Float64Array(4)), to = new Float64Array(4);
  const { curve, path } = run, [start] = rate;
  let kink = nextKink(run, at[0]), share = 1;
  rates(run, at, start);
  for (let n = 0; n < MAX_STEPS; ++n) {
    const q = at[0], dq = start[0];
    let ahead = Infinity;
    if (Math.abs(kink - q) <= 1e-12) {
      if (kink === 0) return true;
      at[0] = kink;
      kink = nextKink(run, kink);
      rates(run, at, start);
      continue;
    }
    if (!curve) {
      if (Math.abs(dq) <= 1e-11) return true;
      ahead = -dq / start[1];
    } else if (run.lam > 0) {
      const left = at[1] ** 2 - 2 * q * start[1] / (curve.exponent + 2);
      share = Math.max(Math.min(Math.sqrt(left), FINER_EVERY), least) / FINER_EVERY;
      ahead = (left - least ** 2) / (2 * run.lam * Math.abs(start[3]));
      if (left <= least ** 2 * (1 + 1e-6)) {
        run.lam = 0;
        at[1] = -Math.abs(at[1]);
        rates(run, at, start);
        continue;
      }
    }
    if (curve ? dq < 0 : dq > 0) ahead = Math.min(ahead, (kink - q) / dq);
    // `slid` needs many points: at least 300 until the usual end of a contact
    const most = path ? Math.max(3, at[2]) / (600 * Math.abs(q)) : Infinity;
    const h = Math.min(ahead, run.step, most);
    let off = advance(run, h, at, rate, to) / (share * rtol);
    if (curve ? to[0] < kink - 1e-7 : to[0] > kink + 1e-7) off = Math.max(30, off);
    if (!(off < Infinity)) return false;
    if (off <= 1) {
      at.set(to);
      start.set(rate[6]);
      if (path) note(run, at);
    }
    if (off > 1 || h === run.step)
      run.step = Math.abs(h) * Math.max(0.2, 0.9 / Math.max(off, 1e-3) ** 0.25);
  }
  return false;
}
function note({ path, force, root, curve, y }, [q, u, t]) {
  const left = curve ? curve.residual * y : 0;
  path.push({ t, u, f: force * forceOn(curve, root * q), d: q * q + left });
}

// ImpactModel.solve, in SI units; null for what it refuses, and beyond lambda = 100, where a bead
// stays and the steps would be too many. `path` takes the points of the contact.
function solve(speed, radius, thickness, rtol = RTOL, least = 1e-7) {
  const hit = atRate(speed / radius, () => solved(speed, radius, thickness, rtol, least, null));
  return hit && Object.assign(hit, { flags: flagsOf(hit) });
}
function solved(speed, radius, thickness, rtol, least, path) {
  if (!(V_MIN <= speed && speed <= V_MAX && R_MIN <= radius && radius <= R_MAX
        && thickness >= Math.max(R_MIN, THINNEST * radius))) return null;
  const { lam, scale, mass, time } = numbersOf(speed, radius, thickness), unit = speed * time;
  const y = scale / unit, force = y ** 1.5, work = 2 * y * force, at = Float64Array.of(0, 1, 0, 0);
  const run = { curve: null, lam, root: y ** -0.5, force, y, path, step: 0.7 * rtol ** 0.2 };
  if (path) note(run, at);
  if (!(lam <= 100 && integrate(run, at, rtol, least))) return null;
  const dm = at[0] ** 2 / y, curve = run.curve = unloading(dm), row = unloadingRow(dm);
  at[0] = Math.sqrt((dm - curve.residual) * y);
  // beyond lambda = 8 the restitution is below 1e-4, which curves take for 0
  if (!(lam > 8 && least > 1e-4) && !integrate(run, at, rtol, least)) return null;
  const other_fraction = row ? work * valueAt(row, OTHER, dm) : 0;
  return { speed, radius, thickness, mass, y, unit, time, inelasticity: lam, other_fraction,
    restitution: Math.min(Math.max(-at[1], 0), 1), contact_time: at[2] * time,
    peak_force: force * loading(Math.sqrt(dm)) * mass * speed / time,
    peak_compression: dm * y * unit, residual_compression: curve.residual * y * unit,
    plastic_fraction: row ? work * valueAt(row, LOSS, dm) - other_fraction : 0,
    wave_fraction: 2 * lam * at[3] };
}
// Of a pair with a rate of strain: a cubic in ln(strength) through the answers of four laws, at the
// same overload. Between two knots the law is a smooth function of the strength.
function atRate(rate, ask) {
  const { knots, nodes, places, slope, share } = pair;
  if (nodes.length === 1) return ask();
  const at = Math.log(1 + slope * Math.max(Math.log(share * rate), 0));
  const piece = Math.max(knots.findIndex((knot) => at <= knot) - 1, 0);
  const [low, high] = knots.slice(piece), x = (2 * at - low - high) / (high - low);
  if (!(x <= 1 + 1e-9)) return null;
  const four = nodes.slice(3 * piece, 3 * piece + 4), weights = places.map((own) =>
    places.reduce((part, other) => (other === own ? part : part * (x - other) / (own - other)), 1));
  const mixed = (values) => (values.every((value) => Number.isFinite(value))
    ? values.reduce((sum, value, n) => sum + weights[n] * value, 0) : nearest(values));
  const nearest = (values) => values[weights.indexOf(Math.max(...weights))];
  const each = (objects, kept) => Object.fromEntries(Object.entries(nearest(objects)).map(
    ([name, value]) => [name, typeof value === "number" && !kept.includes(name)
      ? mixed(objects.map((one) => one[name])) : value]));
  const limits = each(four.map((node) => node.limits), ["always", "flags_when_yielded", "on_yield"]);
  const between = { ...each(four, []), limits }, { scale, saturated } = between;
  const hits = four.map((node) => {
    [law, now] = [node.law, { ...node, scale, saturated }];
    return ask();
  });
  now = between;
  return hits.every(Boolean) ? each(hits, []) : null;
}
function flagsOf({ speed, radius, thickness, unit, contact_time, peak_compression, peak_force }) {
  const { limits } = now, share = limits.share * radius / unit;
  return limits.always
    | (peak_compression > limits.share * radius && limits.on_yield)
    | (radius > limits.slender * thickness && _THIN_PLATE)
    | (thickness < Infinity && contact_time < TRANSITS * thickness * limits.slowness && _THICK_PLATE)
    | (share < limits.least_yield_ratio && limits.flags_when_yielded)
    | ((share < limits.fastest || unit > limits.swiftest * radius) && _FAST_IMPACT)
    | (peak_compression > limits.deepest * radius && _DEEP_CONTACT)
    | (peak_force > limits.bending * thickness ** 2 && _BENT_PLATE)
    | (peak_force > limits.damage * radius ** 2 && _DAMAGE);
}

// Sliding speed after an impact from that before it, psi [mu V0]: contactlaw.equation.tangential.
function slid(path, y, psi) {
  const kappa = pair.tangential_ratio, clip = (wish, most) => Math.min(Math.max(wish, -most), most);
  const stiffness = (largest, d, f) => {
    const dm = largest / y, row = unloadingRow(dm), { residual, exponent } = unloading(dm);
    let [span, work, early] = residual > 0 ? now.returned : [1, 1, 0];
    const back = loading(Math.sqrt(dm)) * (dm - residual) / (0.5 * exponent + 1);
    if (dm > 1 && early > 0) work += early * (work - back / (back + valueAt(row, LOSS, dm)));
    const rise = (0.5 * exponent + 1) * work / span - 1, deep = d - residual * y;
    const k = deep > 0 ? span * rise * f / deep : 0;
    return [k / (1 + 4 / 3 * now.stiffening / Math.sqrt(y) * k), 1 / Math.max(rise - 1, FLATTEST)];
  };
  const peak = path.reduce((most, { d, f }) => Math.max(most, stiffness(d, d, f)[0]), 0);
  const width = peak / SPRINGS, stretch = new Float64Array(SPRINGS);
  const part = (n, k) => Math.min(Math.max(k - n * width, 0), n < SPRINGS - 1 ? width : Infinity);
  let speed = psi, ratio = clip(kappa * psi, 1), largest = 0, before = 0;
  for (let i = 1; i < path.length; ++i) {
    const { t, u, d, f } = path[i], half = 0.5 * POINT * (path[i - 1].u - u);
    speed -= half * ratio;
    const moved = (t - path[i - 1].t) * speed, held = Math.max(largest, y);
    const left = d > held ? Math.exp(RELAXING * (Math.log(held / d) - y / d + y / held)) : 1;
    largest = Math.max(largest, d);
    const [k, power] = stiffness(largest, d, f);
    let within = 0, total = 0;
    for (let n = 0; n < SPRINGS && f > 0; ++n) {
      const wide = part(n, k), old = Math.min(part(n, before), wide), x = (n * width + wide) / k;
      const share = x * (1 + (1 - x ** power) / power), most = f * (share - within);
      const wish = old * left * stretch[n] + 0.25 * (1 + left) * (wide + old) * moved;
      const pulled = wide > 0 ? clip(kappa * wish, most) : 0;
      stretch[n] = wide > 0 ? pulled / (kappa * wide) : 0;
      within = share;
      total += pulled;
    }
    if (f > 0) [before, ratio] = [k, total / f];
    speed -= half * ratio;
  }
  return speed;
}
// ImpactModel.oblique of a bead without spin, from its speed and the angle from the normal [deg].
function collide(bead, angle, radius, thickness, friction) {
  const tilt = angle * Math.PI / 180, speed = bead * Math.cos(tilt);
  if (!(friction <= ROUGHEST)) return null;
  const hit = atRate(speed / radius, () => slides(speed, bead * Math.sin(tilt), radius, thickness,
    friction));
  if (!hit) return null;
  const deep = hit.peak_compression - hit.residual_compression;
  const sum = hit.size + Math.abs(hit.sliding_speed);
  const wide = _UNLOADING * hit.peak_force / deep / (2 * pair.modulus);
  const slide = sum > 0
    ? 0.5 * (hit.size ** 2 + hit.sliding_speed ** 2) / sum * hit.contact_time / wide : 0;
  const traction = friction * hit.peak_force / (Math.PI * wide ** 2) / pair.strength;
  const flows = traction >= _TRACTION || slide > _SLIDE || traction * slide > _PRODUCT;
  const flags = flagsOf(hit) | (flows && hit.residual_compression > 0 && pair.SLIDING_FLOW);
  return Object.assign(hit, { flags, normal_share: Math.cos(tilt) ** 2,
    friction_share: hit.friction_share / bead ** 2 });
}
function slides(speed, size, radius, thickness, friction) {
  const path = [], hit = solved(speed, radius, thickness, RTOL, 1e-7, path);
  if (!hit) return null;
  const limit = friction * hit.speed, psi = limit > 0 ? Math.min(size / limit, FASTEST) : 0;
  const changed = psi > 0 ? limit * (psi - slid(path, hit.y, psi)) : 0, after = size - changed;
  return Object.assign(hit, { path, size, sliding_speed: after, along: size - changed / POINT,
    spin: (1 - 1 / POINT) * changed / radius,
    friction_share: changed * (size + after) / POINT });
}
