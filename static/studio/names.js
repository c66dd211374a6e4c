// Names of faces by what differs: the method, and of methods that stand twice the parameters that are not alike.

/// What a parameter is in a name, in few words.
function words(key, value) {
  if (Array.isArray(value)) return typeof value[0] === "string" ? `${key} ${value.length}` : `${key} ${value.join("–")}`;
  if (value !== null && typeof value === "object") return `${key} ${Object.keys(value).length}`;
  if (typeof value === "number") return `${key} ${Number(value.toPrecision(4))}`;
  return `${key} ${value}`;
}

/// `faces`: [{letter, method, settings: the method as it was solved, or null, usual: its parameters' defaults by key}];
/// a name for each. A method that stands once is named by what of it is unusual.
export function namesOf(faces) {
  const text = (value) => JSON.stringify(value ?? null);
  const names = faces.map(({ method, settings, usual }) => {
    if (!settings) return method;
    const like = faces.filter((other) => other.method === method && other.settings);
    const keys = [...new Set(like.flatMap((other) => Object.keys(other.settings)))].filter((key) => key !== "method");
    const told = keys.filter((key) => (like.length > 1 ? like.some((other) => text(other.settings[key]) !== text(settings[key])) : key in usual && text(settings[key]) !== text(usual[key])));
    return [method, ...told.map((key) => (settings[key] === undefined || settings[key] === null ? `${key} –` : words(key, settings[key])))].join(", ");
  });
  // Faces that are alike in everything keep their letters.
  return names.map((name, i) => (names.indexOf(name) === names.lastIndexOf(name) ? name : `${name} (${faces[i].letter})`));
}
