// An open IFC file: its entities by name, and the relations between them that a reader asks for.

/** Text of an attribute; "" when it has none. */
export const textOf = (attribute) => (typeof attribute?.value === 'string' ? attribute.value.trim() : '');
/** Number of an attribute; undefined when it has none. */
export const numberOf = (attribute) => {
  const value = typeof attribute === 'number' ? attribute : Number(attribute?.value ?? NaN);
  return Number.isFinite(value) ? value : undefined;
};
/** The id that an attribute refers to; undefined when it refers to nothing. */
export const idOf = (attribute) => (attribute?.type === 5 && attribute.value > 0 ? attribute.value : undefined);
/** The ids of a list of references. */
export const idsOf = (attribute) =>
  (Array.isArray(attribute) ? attribute : attribute ? [attribute] : []).map(idOf).filter((id) => id !== undefined);

export class IfcFile {
  constructor(WebIfc, api, model) {
    this.WebIfc = WebIfc;
    this.api = api;
    this.model = model;
    this.className = new Map();
  }

  /** Ids of all entities of a class; of its subclasses too unless `exactly`. */
  all(name, exactly = false) {
    const code = this.WebIfc[name.toUpperCase()];
    return code === undefined ? [] : [...this.api.GetLineIDsWithType(this.model, code, !exactly)];
  }

  /** The entity with its attributes; undefined when there is none, or one that is broken. */
  get(id) {
    if (id === undefined) return undefined;
    try {
      return this.api.GetLine(this.model, id) ?? undefined;
    } catch {
      return undefined;
    }
  }

  /** "IfcWall" of an entity. */
  classOf(entity) {
    if (!entity) return '';
    let name = this.className.get(entity.type);
    if (name === undefined) {
      name = entity.constructor?.name ?? '';
      if (!/^Ifc[A-Za-z]/.test(name)) name = String(this.api.GetNameFromTypeCode(entity.type) ?? '');
      this.className.set(entity.type, name);
    }
    return name;
  }

  /** Of a relationship class: id of each related object -> ids that it is related to, in the file's order. */
  relation(name, relating, related) {
    const of = new Map();
    for (const id of this.all(name)) {
      const line = this.get(id);
      const target = idOf(line?.[relating]);
      if (target === undefined) continue;
      for (const object of idsOf(line[related])) {
        if (!of.has(object)) of.set(object, []);
        of.get(object).push(target);
      }
    }
    return of;
  }
}
