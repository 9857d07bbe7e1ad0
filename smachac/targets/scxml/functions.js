// The functions that generated documents may contain. A document contains those that it uses.
// Each starts in the first column, and a blank line separates them.

// Userdata of a container: reading a key that holds nothing is an error.
function userdata(keys) {
  return new Proxy(keys, {
    get(held, key) {
      if (!(key in held)) throw new ReferenceError(`the key "${String(key)}" holds nothing`);
      return held[key];
    }
  });
}

// The keys that a state does not declare as inputs cannot be read.
function undeclared(key) {
  throw new ReferenceError(`"${key}" is not one of its inputs`);
}

// Copies keys that hold something; `names` maps each to its name on the other side.
function copy(from, to, names) {
  for (const key of Object.keys(names)) if (key in from) to[names[key]] = from[key];
}

// What the host gets of the userdata: the inputs of a state under its own names, or all keys.
function view(keys, names, open) {
  const found = open ? Object.assign({}, keys) : {};
  for (const key of Object.keys(names)) if (names[key] in keys) found[key] = keys[names[key]];
  return found;
}

// An answer of the host: the outputs of a state, and whether it has served a request to stop.
// Returns the keys that were written; others than the declared ones are dropped.
function receive(state, data, keys, names, open) {
  const written = Object.keys(data.outputs).filter(key => open || key in names);
  written.forEach(key => { keys[key in names ? names[key] : key] = data.outputs[key]; });
  if (data.answered) delete requested[state];
  return written;
}

// A request to stop reaches a state and all states that run in it; returns them.
function request(state) {
  requested[state] = true;
  return [].concat([state], ...(running[state] || []).map(request));
}

// Takes back the requests of a state and of all states in it.
function recall(state) {
  delete requested[state];
  (inside[state] || []).forEach(recall);
}

// A state of a machine starts. It gets the request of the machine, unless the state before it has
// answered that.
function enter(machine, state) {
  const before = previous[machine];
  delete previous[state];
  if (requested[machine] && before && !requested[before]) {
    delete requested[machine];
  } else if (requested[machine]) {
    delete requested[before];
    request(state);
  }
  running[machine] = [state];
  previous[machine] = state;
}

// A machine ends. Its request is answered if its last state has none.
function leave(machine) {
  delete running[machine];
  if (!requested[previous[machine]]) delete requested[machine];
}

// States of a concurrence, or the state of an iterator, start: they get its request.
function start(container, states) {
  running[container] = states.slice();
  states.forEach(function (state) {
    delete previous[state];
    if (requested[container] && !requested[state]) request(state);
  });
}

// A branch of a concurrence ends. If `stop` is true, the others get a request, once; returns the
// states that got it.
function end(concurrence, state, stop) {
  const others = running[concurrence] = running[concurrence].filter(other => other !== state);
  if (!stop || stopping[concurrence]) return [];
  stopping[concurrence] = true;
  return requested[concurrence] ? [] : [].concat(...others.map(request));
}

// A concurrence ends. Its request is answered if its branches have none; theirs are taken back.
function join(concurrence) {
  const open = inside[concurrence].filter(state => requested[state]);
  delete running[concurrence];
  delete stopping[concurrence];
  open.forEach(recall);
  if (open.length === 0) delete requested[concurrence];
}

// An iterator ends. If `answers` is true, its request counts as answered.
function finish(iterator, answers) {
  delete running[iterator];
  if (answers && requested[iterator]) recall(iterator);
}

// A duration in seconds as a delay of SCXML.
function delay(seconds) {
  if (typeof seconds !== "number") throw new TypeError("the duration is not a number of seconds");
  return `${Math.max(0, seconds).toFixed(6)}s`;
}

// The functions below have the results that Python has.

// The name of a type, for messages of errors.
function kind(value) {
  if (value === null || value === undefined) return "None";
  return Array.isArray(value) ? "list" : typeof value;
}

// A whole number, which is exact.
function whole(number) {
  if (Number.isInteger(number) && !Number.isSafeInteger(number)) {
    throw new RangeError("an integer beyond 53 bits");
  }
  return number;
}

// A number; true and false are 1 and 0.
function number(value) {
  if (typeof value !== "number" && typeof value !== "boolean") {
    throw new TypeError(`${kind(value)} is not a number`);
  }
  return Number(value);
}

// `one + other` of values whose types are not known.
function plus(one, other) {
  if (typeof one === "string" && typeof other === "string") return one + other;
  if (Array.isArray(one) && Array.isArray(other)) return one.concat(other);
  return whole(number(one) + number(other));
}

// `one - other` of values whose types are not known.
function minus(one, other) {
  return whole(number(one) - number(other));
}

// `one * other` of values whose types are not known.
function times(one, other) {
  const sequence = v => typeof v === "string" || Array.isArray(v);
  if (sequence(other)) return times(other, one);
  if (!sequence(one)) return whole(number(one) * number(other));
  const count = Math.max(0, number(other));
  if (!Number.isInteger(count)) throw new TypeError("a list is repeated by integers only");
  if (one.length === 0) return one;
  if (count * one.length > 100000) throw new RangeError("more than 100000 items");
  if (typeof one === "string") return one.repeat(count);
  return [].concat(...Array(count).fill(one));
}

// `one / other`.
function divided(one, other) {
  if (number(other) === 0) throw new RangeError("division by zero");
  return number(one) / number(other);
}

// `one % other`: it has the sign of `other`.
function remainder(one, other) {
  if (number(other) === 0) throw new RangeError("division by zero");
  const left = number(one) % number(other);
  return left !== 0 && (left < 0) !== (other < 0) ? left + number(other) : left;
}

// `one // other`: the integer below the quotient.
function floored(one, other) {
  const left = remainder(one, other);
  const quotient = (number(one) - left) / number(other);
  const below = Math.floor(quotient);
  return quotient - below > 0.5 ? below + 1 : below;
}

// `one ** other` of integers, `other` not negative.
function power(one, other) {
  const found = Math.pow(number(one), other);
  return Number.isFinite(found) ? whole(Math.round(found)) : whole(Number.MAX_VALUE);
}

// The truth of a value: empty texts, lists and mappings are false.
function truth(value) {
  if (value === null || value === undefined) return false;
  if (typeof value === "number") return value !== 0;
  if (typeof value === "object") return Object.keys(value).length > 0;
  return Boolean(value);
}

// `one == other`: lists and mappings are equal if their items are; true equals 1.
function equal(one, other) {
  if (one === null || other === null || typeof one !== "object" || typeof other !== "object") {
    const plain = v => (typeof v === "boolean" ? Number(v) : v);
    return plain(one) === plain(other);
  }
  const keys = Object.keys(one);
  return Array.isArray(one) === Array.isArray(other) && keys.length === Object.keys(other).length &&
    keys.every(key => Object.prototype.hasOwnProperty.call(other, key) && equal(one[key], other[key]));
}

// `one < other`: texts by code points, lists by their first items that differ.
function less(one, other) {
  if (typeof one === "string" && typeof other === "string") {
    return less(Array.from(one, c => c.codePointAt(0)), Array.from(other, c => c.codePointAt(0)));
  }
  if (Array.isArray(one) && Array.isArray(other)) {
    for (let at = 0; at < Math.min(one.length, other.length); at += 1) {
      if (!equal(one[at], other[at])) return less(one[at], other[at]);
    }
    return one.length < other.length;
  }
  return number(one) < number(other);
}

// `one <= other`.
function atMost(one, other) {
  if (typeof one === "number" && typeof other === "number") return one <= other;
  return less(one, other) || equal(one, other);
}

// `item in values`.
function contains(item, values) {
  if (typeof values === "string") {
    if (typeof item !== "string") throw new TypeError("a text contains only texts");
    return values.includes(item);
  }
  if (Array.isArray(values)) return values.some(value => equal(item, value));
  if (values === null || typeof values !== "object") throw new TypeError(`${kind(values)} has no items`);
  if (item !== null && typeof item === "object") throw new TypeError("a list is no key");
  return typeof item === "string" && Object.prototype.hasOwnProperty.call(values, item);
}

// The items that a function goes through: the characters of a text, the keys of a mapping.
function items(values) {
  if (Array.isArray(values)) return values;
  if (typeof values === "string") return Array.from(values);
  if (values === null || typeof values !== "object") throw new TypeError(`${kind(values)} has no items`);
  const keys = Object.keys(values);
  if (keys.some(key => /^\d+$/.test(key))) throw new TypeError("JavaScript sorts keys that are numbers");
  return keys;
}

// `values[place]`: negative places count from the end.
function item(values, place) {
  if (Array.isArray(values) || typeof values === "string") {
    const found = items(values), at = number(place);
    if (!Number.isInteger(at)) throw new TypeError("the place is not an integer");
    if (at < -found.length || at >= found.length) throw new RangeError("index out of range");
    return found[at < 0 ? at + found.length : at];
  }
  if (typeof place !== "string" || !contains(place, values)) throw new ReferenceError(`no key ${place}`);
  return values[place];
}

// `abs(value)`.
function absolute(value) {
  return Math.abs(number(value));
}

// `len(values)`.
function size(values) {
  if (typeof values === "string") return Array.from(values).length;
  if (values === null || typeof values !== "object") throw new TypeError(`${kind(values)} has no length`);
  return Object.keys(values).length;
}

// `int(value)`.
function integer(value) {
  if (typeof value === "string") {
    const text = value.trim();
    if (!/^[+-]?\d+(_\d+)*$/.test(text)) throw new TypeError("the text is not an integer");
    return whole(Number(text.replace(/_/g, "")));
  }
  const found = Math.trunc(number(value));
  if (!Number.isFinite(found)) throw new RangeError("the number has no integer");
  return whole(found);
}

// `float(value)`.
function real(value) {
  if (typeof value !== "string") return number(value);
  const text = value.trim().toLowerCase(), plain = text.replace(/(\d)_(?=\d)/g, "$1");
  if (/^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/.test(plain)) return Number(plain);
  const named = /^([+-]?)(inf|infinity|nan)$/.exec(text);
  if (!named) throw new TypeError("the text is not a number");
  return named[2] === "nan" ? NaN : named[1] === "-" ? -Infinity : Infinity;
}

// `round(value)`: the nearest integer, the even one of two.
function rounded(value) {
  const below = Math.floor(number(value)), rest = number(value) - below;
  if (!Number.isFinite(below)) throw new RangeError("the number has no integer");
  return whole(rest < 0.5 || (rest === 0.5 && below % 2 === 0) ? below : below + 1);
}

// `str(value)` of a whole number, a truth value, a text or None.
function text(value) {
  if (typeof value === "boolean") return value ? "True" : "False";
  return value === null ? "None" : String(value);
}

// `str(value)` of a float.
function realText(value) {
  if (!Number.isFinite(value)) return value !== value ? "nan" : value < 0 ? "-inf" : "inf";
  if (Object.is(value, -0)) return "-0.0";
  const [digits, power] = value.toExponential().split("e"), exponent = Number(power);
  if (exponent < -4 || exponent >= 16) {
    return `${digits}e${exponent < 0 ? "-" : "+"}${String(Math.abs(exponent)).padStart(2, "0")}`;
  }
  const plain = String(value);
  if (/e/.test(plain)) return value.toFixed(Math.max(1, -exponent + digits.replace(/[-.]/g, "").length - 1));
  return plain.includes(".") ? plain : `${plain}.0`;
}

// `range(...)` as a list.
function range(first, last, step) {
  if (last === undefined) return range(0, first, 1);
  const by = step === undefined ? 1 : step, found = [];
  if (![first, last, by].every(v => Number.isInteger(number(v)))) throw new TypeError("range of integers only");
  if (Number(by) === 0) throw new RangeError("the step of a range is 0");
  for (let at = Number(first); by > 0 ? at < last : at > last; at += Number(by)) {
    if (found.length >= 100000) throw new RangeError("more than 100000 items");
    found.push(at);
  }
  return found;
}

// `sum(values, start)`.
function total(values, start) {
  return items(values).reduce(plus, start);
}

// `sorted(values, reverse=..., key=...)`.
function sorted(values, reverse, key) {
  const pairs = items(values).map(value => [key ? key(value) : value, value]);
  pairs.sort((a, b) => {
    const [one, other] = reverse ? [b, a] : [a, b];
    return less(one[0], other[0]) ? -1 : less(other[0], one[0]) ? 1 : 0;
  });
  return pairs.map(pair => pair[1]);
}

// `max(values, key=...)`; `min` with `smallest`.
function largest(values, key, smallest) {
  const pairs = items(values).map(value => [key ? key(value) : value, value]);
  if (pairs.length === 0) throw new RangeError("no items");
  return pairs.reduce((best, pair) => {
    return (smallest ? less(pair[0], best[0]) : less(best[0], pair[0])) ? pair : best;
  })[1];
}
