#pragma once
// The style sheet of a report, for screen and paper, with installed fonts.

namespace freevoxels {

inline constexpr const char* kReportStyle = R"css(
:root { color-scheme: light; --ink: #1c2126; --quiet: #66707a; --line: #d5dade; --pass: #1b6e3c; --fail: #b3261e; }
* { box-sizing: border-box; }
body { margin: 0; background: #fff; color: var(--ink); font: 16px/1.55 Georgia, "Times New Roman", serif; }
main { max-width: 62rem; margin: 0 auto; padding: 2.5rem 1.5rem 4rem; }
h1, h2, dl, nav, table, figcaption, .verdict, .failures, svg {
  font-family: "Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif; }
h1 { margin: 0 0 .6rem; font-size: 1.9rem; font-weight: 600; letter-spacing: -.01em; }
h2 { margin: 2.6rem 0 .7rem; padding-bottom: .3rem; border-bottom: 1px solid var(--line); font-size: 1.2rem; font-weight: 600; }
a { color: inherit; text-decoration-color: var(--line); text-underline-offset: .2em; }
.pass { color: var(--pass); }
.fail { color: var(--fail); font-weight: 700; }
.quiet { color: var(--quiet); }
.verdict { display: inline-block; margin: 0 0 1.4rem; padding: .25rem .8rem; border: 1px solid; border-radius: 3px; font-weight: 600; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .15rem 1.2rem; margin: 0; font-size: .85rem; }
dt { color: var(--quiet); }
dd { margin: 0; overflow-wrap: anywhere; }
nav { font-size: .92rem; }
nav ol, .failures ul { margin: 0; padding-left: 1.6rem; }
nav .quiet, nav .fail { font-size: .85em; margin-left: .4rem; }
.failures { font-size: .92rem; }
.failures h2 { color: var(--fail); }
.text { max-width: 44rem; white-space: pre-line; }
table { width: 100%; margin: 1.2rem 0; border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }
caption { caption-side: bottom; padding-top: .5rem; color: var(--quiet); text-align: left; }
th, td { padding: .35rem .8rem .35rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid var(--line); }
thead th { border-bottom: 1.5px solid var(--ink); font-weight: 600; }
tbody th { font-weight: 400; }
.number { text-align: right; white-space: nowrap; }
.failed th, .failed td { background: #fcefed; }
figure { margin: 1.6rem 0; break-inside: avoid; }
figcaption { margin-top: .5rem; color: var(--quiet); font-size: .85rem; }
.images { display: flex; flex-wrap: wrap; gap: 1rem; }
.images figure { flex: 1 1 12rem; margin: 0; }
.images figcaption { color: var(--ink); }
img { display: block; max-width: 100%; height: auto; }
.small { image-rendering: pixelated; }
.plot { display: block; width: 100%; max-width: 720px; }
@media print { main { max-width: none; padding: 0; } body { font-size: 10.5pt; } tr, h2 { break-inside: avoid; break-after: auto; } }
)css";

}  // namespace freevoxels
