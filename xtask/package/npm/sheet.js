// How an element is laid out; the page's own rules for `mimique-stage` come before `:host`.

export const sheet = new CSSStyleSheet();
sheet.replaceSync(`
:host { display: inline-block; position: relative; width: 480px; max-width: 100%; aspect-ratio: 1; overflow: hidden; vertical-align: top; }
:host([hidden]) { display: none; }
.stage-frame, canvas, video { position: absolute; inset: 0; width: 100%; height: 100%; }
canvas { display: block; }
canvas[data-waiting] { opacity: 0.4; }
video { object-fit: contain; }
video[hidden] { display: none; }
p { position: absolute; inset: 0; margin: 0; padding: 0.75em; overflow: auto; box-sizing: border-box;
    font: 0.875rem/1.4 system-ui, sans-serif; text-align: start; overflow-wrap: anywhere; background: #fff; color: #a00000; }
p[hidden] { display: none; }
`);
