// What is shown, in one place. The parts of the page read it and are told what has changed.

export function createStore(values) {
  const listeners = [];
  let queued = null;
  return {
    get: () => values,
    set(patch) {
      const changed = Object.keys(patch).filter((key) => values[key] !== patch[key]);
      if (!changed.length) return;
      values = { ...values, ...patch };
      if (queued) {  // a listener has set something: listeners are told after the current change
        changed.forEach((key) => queued.add(key));
        return;
      }
      let keys = new Set(changed);
      while (keys.size) {
        queued = new Set();
        for (const { wanted, call } of listeners) if (wanted.some((key) => keys.has(key))) call(values, keys);
        keys = queued;
      }
      queued = null;
    },
    on(wanted, call) {
      listeners.push({ wanted, call });
    },
  };
}
