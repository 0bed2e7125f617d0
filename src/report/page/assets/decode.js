// Planes of a viewer: inflated bytes, and what they say of a pixel.

/** Bytes of deflated base64. */
async function unpack(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

const BACKGROUND = 0;
const LIT = 2;
const OCCLUDED = 3;
const A_WRONG = 4;
const B_WRONG = 5;
const BOTH_WRONG = 6;
const NOT_RECEIVING = 8;
const TOUCHING_RIGHT = 9;

/** One light's planes, and two testers that are held against each other. */
class Answers {
  constructor(data, codes, masks) {
    this.data = data;
    this.codes = codes;
    this.masks = masks;
    this.truth = data.testers.indexOf(data.truth);
    this.a = this.b = this.truth;
  }

  static async of(data, light) {
    const [codes, ...masks] = await Promise.all([light.codes, ...light.masks].map(unpack));
    return new Answers(data, codes, masks);
  }

  /** Whether a light was asked for at a pixel. */
  isQuery(at) {
    const code = this.codes[at] & 15;
    return code >= LIT && code <= BOTH_WRONG;
  }

  occluded(tester, at) {
    return ((this.masks[tester >> 3][at] >> (tester & 7)) & 1) === 1;
  }

  /** Why Embree is wrong there: 0 if it is not known, else 1 to 3. */
  cause(at) {
    return this.codes[at] >> 5;
  }

  isTouching(at) {
    return (this.codes[at] & 16) !== 0;
  }

  /** The category of the verdict map. */
  verdict(at) {
    if (!this.isQuery(at)) return this.codes[at] & 15;
    const truth = this.occluded(this.truth, at);
    const aWrong = this.occluded(this.a, at) !== truth;
    const bWrong = this.occluded(this.b, at) !== truth;
    if (aWrong && bWrong && this.a !== this.b) return BOTH_WRONG;
    if (aWrong) return A_WRONG;
    if (bWrong) {
      const cause = this.data.testers[this.b] === "embree" ? this.cause(at) : 0;
      return cause ? TOUCHING_RIGHT + cause : B_WRONG;
    }
    if (this.isTouching(at)) return TOUCHING_RIGHT;
    return truth ? OCCLUDED : LIT;
  }

  /** The category of the difference map. */
  difference(at) {
    if (!this.isQuery(at)) {
      const code = this.codes[at] & 15;
      return code === BACKGROUND ? 0 : code === NOT_RECEIVING ? 2 : 1;
    }
    const a = this.occluded(this.a, at);
    const b = this.occluded(this.b, at);
    return a === b ? (a ? 4 : 3) : a ? 5 : 6;
  }

  /** A tester's shadows, in the categories of verdicts. */
  shadow(tester, at) {
    if (!this.isQuery(at)) return this.codes[at] & 15;
    return this.occluded(tester, at) ? OCCLUDED : LIT;
  }
}
