// history.js: how a run went, for the picture, in a memory that is bounded however long the run is. Values are kept in two
// resolutions: the last minutes as they were, and the whole run in steps that become coarser.

const FINE_POINTS = 6000; // twice as many at most
const COARSE_STEPS = 2048;
const LANE_CHANGES = 400;
export const SAMPLE_MS = 10;

/** A value over time. Sources for timeline.js. */
class Line {
  constructor() {
    this.fine = { from: 0, to: 0, step: 0, t: [], lo: [] };
    this.coarse = { from: 0, to: 0, step: SAMPLE_MS, t: [], lo: [], hi: [] };
  }

  /** @param value null: there is none */
  add(t, value) {
    const { fine } = this;
    if (!fine.t.length || fine.lo[fine.lo.length - 1] !== value) {
      fine.t.push(t);
      fine.lo.push(value);
    }
    if (fine.t.length >= 2 * FINE_POINTS) {
      fine.t.splice(0, FINE_POINTS);
      fine.lo.splice(0, FINE_POINTS);
      [fine.from] = fine.t;
    }
    fine.to = t + SAMPLE_MS;
    this.addCoarse(t, value);
  }

  addCoarse(t, value) {
    const { coarse } = this;
    const begin = Math.floor(t / coarse.step) * coarse.step;
    const last = coarse.t.length - 1;
    coarse.to = t + SAMPLE_MS;
    if (last < 0 || coarse.t[last] !== begin) {
      coarse.t.push(begin);
      coarse.lo.push(value);
      coarse.hi.push(value);
      if (coarse.t.length > COARSE_STEPS) this.halve();
    } else if (value !== null) {
      coarse.lo[last] = coarse.lo[last] === null ? value : Math.min(coarse.lo[last], value);
      coarse.hi[last] = coarse.hi[last] === null ? value : Math.max(coarse.hi[last], value);
    }
  }

  /** Each two steps become one. */
  halve() {
    const { t, lo, hi } = this.coarse;
    const step = this.coarse.step * 2;
    this.coarse = { from: 0, to: this.coarse.to, step, t: [], lo: [], hi: [] };
    t.forEach((time, i) => {
      if (lo[i] === null) this.addCoarse(time, null);
      else [lo[i], hi[i]].forEach((value) => this.addCoarse(time, value));
    });
  }

  sources() {
    return [this.fine, this.coarse];
  }
}

/** What changes by steps: state, gear, mode. */
class Lane {
  constructor() {
    this.changes = []; // [time, value]
  }

  add(t, value) {
    if (this.changes.length && this.changes[this.changes.length - 1][1] === value) return;
    this.changes.push([t, value]);
    if (this.changes.length > LANE_CHANGES) this.changes.splice(0, LANE_CHANGES / 2);
  }

  /** Spans for timeline.js. @param tone of a value; a value without a text is left out */
  spans(now, tone, text = String) {
    return this.changes.map(([from, value], i) => ({ from, to: this.changes[i + 1]?.[0] ?? now, text: text(value), tone: tone(value), value }))
      .filter((span) => span.value !== null && span.value !== "");
  }
}

export class History {
  constructor() {
    this.lines = {};
    this.lanes = {};
    this.faults = new Map(); // name: Lane
  }

  line(name, t, value) {
    (this.lines[name] ??= new Line()).add(t, value);
  }

  lane(name, t, value) {
    (this.lanes[name] ??= new Lane()).add(t, value);
  }

  fault(name, t, kind) {
    if (!this.faults.has(name)) this.faults.set(name, new Lane());
    this.faults.get(name).add(t, kind);
  }
}
