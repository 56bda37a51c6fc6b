// What is worth a word, one line a kind: how many, and the first name.

const kMostKinds = 500;  // of more, the others are counted together
const kOther = `has notes of more than ${kMostKinds} kinds, of which these are left out`;

export class Notes {
  constructor() {
    this.kinds = new Map();
  }

  add(what, name = '') {
    const key = this.kinds.has(what) || this.kinds.size < kMostKinds ? what : kOther;
    const kind = this.kinds.get(key);
    if (kind) ++kind.count;
    else this.kinds.set(key, { what: key, count: 1, first: name });
  }

  list() {
    return [...this.kinds.values()];
  }
}
