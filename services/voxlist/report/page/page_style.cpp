#include "services/voxlist/report/page/page_style.h"

namespace voxlist::desk {

const char* const kPageStyle = R"~~~(
:root {
  color-scheme: light dark;
  --back: #f7f6f2; --card: #ffffff; --ink: #22272c; --dim: #646c73; --line: #dedcd4; --grid: #ebe9e3;
  --ours: #1f6fb5; --paper: #c2410c; --second: #15803d; --third: #7e3fb0; --map: #9aa3ab; --faint: #b9bfc4;
}
@media (prefers-color-scheme: dark) {
  :root {
    --back: #11151a; --card: #191f26; --ink: #e2e6ea; --dim: #96a0a9; --line: #303942; --grid: #252d35;
    --ours: #62b0ee; --paper: #fb9a5b; --second: #5cc98a; --third: #c296ea; --map: #66717b; --faint: #4d5761;
  }
}
@media print { :root { --back: #ffffff; } section { break-inside: avoid; } }
* { box-sizing: border-box; }
body {
  margin: 0 auto; max-width: 1180px; padding: 28px 20px 60px; background: var(--back); color: var(--ink);
  font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; font-variant-numeric: tabular-nums;
}
h1 { font-size: 26px; line-height: 1.2; margin: 0 0 8px; }
h2 { font-size: 19px; margin: 0 0 10px; }
a { color: var(--ours); }
p { margin: 6px 0; max-width: 84ch; }
code { font: 13px/1.4 ui-monospace, "DejaVu Sans Mono", monospace; overflow-wrap: anywhere; }
section {
  background: var(--card); border: 1px solid var(--line); border-radius: 10px; padding: 18px 20px; margin: 18px 0;
}
dl.facts { display: grid; grid-template-columns: max-content 1fr; gap: 2px 16px; margin: 14px 0; }
dl.facts dt, .dim, figcaption, caption, .setup { color: var(--dim); }
dl.facts dd { margin: 0; }
blockquote { margin: 8px 0; padding: 2px 14px; border-left: 4px solid var(--paper); max-width: 84ch; }
.wide { overflow-x: auto; margin: 10px 0; }
table { border-collapse: collapse; font-size: 14px; }
caption { text-align: left; padding: 4px 0; }
th, td { text-align: right; padding: 3px 14px 3px 0; border-bottom: 1px solid var(--line); vertical-align: top; }
th { font-weight: 600; color: var(--dim); }
th:first-child, td:first-child, td.words, th.words { text-align: left; }
td.paper { color: var(--paper); font-weight: 600; }
td.ours { color: var(--ours); font-weight: 600; }
.timed::after { content: "\2009\2020"; color: var(--dim); font-weight: 400; }
.panels { display: flex; flex-wrap: wrap; gap: 14px 18px; margin: 12px 0; }
figure { margin: 0; max-width: 100%; }
figure svg { max-width: 100%; height: auto; display: block; }
figcaption { font-size: 13px; max-width: 60ch; }
footer dl { font-size: 13px; display: grid; grid-template-columns: max-content 1fr; gap: 2px 12px; margin: 10px 0 0; }
footer dt { color: var(--dim); }
footer dd { margin: 0; }
svg text { fill: var(--ink); font-family: system-ui, "DejaVu Sans", sans-serif; }
svg text.title { font-size: 13px; font-weight: 600; }
svg text.label { font-size: 11px; fill: var(--dim); }
svg text.tick { font-size: 11px; fill: var(--dim); }
svg .line { fill: none; stroke-width: 2; stroke-linejoin: round; stroke-linecap: round; }
svg .thin { stroke-width: 1; }
svg .dots { fill: none; stroke-linecap: round; }
svg .dashed { stroke-dasharray: 5 4; stroke-linecap: butt; }
svg .grid { stroke: var(--grid); stroke-width: 1; }
svg .axis { stroke: var(--dim); stroke-width: 1; }
svg .ours { stroke: var(--ours); } svg .fill.ours { fill: var(--ours); stroke: none; }
svg .paper { stroke: var(--paper); } svg .fill.paper { fill: var(--paper); stroke: none; }
svg .second { stroke: var(--second); } svg .fill.second { fill: var(--second); stroke: none; }
svg .third { stroke: var(--third); } svg .fill.third { fill: var(--third); stroke: none; }
svg .map { stroke: var(--map); } svg .fill.map { fill: var(--map); stroke: none; }
svg .faint { stroke: var(--faint); } svg .fill.faint { fill: var(--faint); stroke: none; }
svg .bar { fill-opacity: 0.55; }
svg .frame { fill: none; stroke-width: 1.2; }
svg .shade1 { fill-opacity: 0.16; } svg .shade2 { fill-opacity: 0.28; } svg .shade3 { fill-opacity: 0.4; }
svg .shade4 { fill-opacity: 0.52; } svg .shade5 { fill-opacity: 0.64; } svg .shade6 { fill-opacity: 0.76; }
svg .shade7 { fill-opacity: 0.88; } svg .shade8 { fill-opacity: 1; }
)~~~";

}  // namespace voxlist::desk
