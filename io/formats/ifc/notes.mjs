// What is worth a word, one line a kind: how many, and the first name.

export class Notes {
  constructor() {
    this.kinds = new Map();
  }

  add(what, name = '') {
    const kind = this.kinds.get(what);
    if (kind) ++kind.count;
    else if (this.kinds.size < 500) this.kinds.set(what, { what, count: 1, first: name });
  }

  list() {
    return [...this.kinds.values()];
  }
}
