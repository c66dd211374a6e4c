// Workers of modules that may lie on another host than the page (a content delivery network of npm packages, say):
// browsers start workers from the page's own host alone, whose script may import what others serve. In a capsule Worker is
// another one, which takes any address.

/// The worker of a module by its address, a URL.
export function moduleWorker(address) {
  const page = globalThis.location?.origin ?? address.origin;
  if (address.origin === page || Worker.anyHost) return new Worker(address, { type: "module" });
  const script = URL.createObjectURL(new Blob([`import ${JSON.stringify(address.href)};`], { type: "text/javascript" }));
  return new Worker(script, { type: "module" });
}
