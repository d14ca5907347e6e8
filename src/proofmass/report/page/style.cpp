#include "proofmass/report/page/style.hpp"

namespace proofmass::report {

std::string_view page_css() {
  return R"(*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.55 system-ui,sans-serif}
main{max-width:60rem;margin:0 auto;padding:2.5rem 1.5rem 4rem}
.from{margin:0;color:var(--soft);font-size:.85rem;letter-spacing:.04em}
h1{font-size:1.05rem;font-weight:600;margin:.2rem 0 1.6rem;overflow-wrap:anywhere}
.conclusion{font-size:1.55rem;line-height:1.35;font-weight:500;margin:0 0 1.6rem;max-width:46rem}
dl.key{display:flex;flex-wrap:wrap;gap:1px;margin:0 0 2rem;
background:var(--rule);border:1px solid var(--rule);border-radius:6px;overflow:hidden}
dl.key div{flex:1 1 15rem;background:var(--panel);padding:.7rem .9rem}dl.key dt{color:var(--soft);font-size:.82rem}
dl.key dd{margin:0;font-size:1.08rem;font-variant-numeric:tabular-nums}
h2{font-size:1.15rem;margin:2.6rem 0 .6rem;padding-bottom:.3rem;border-bottom:1px solid var(--rule)}
p{margin:.5rem 0;max-width:46rem}ul{margin:.5rem 0;padding-left:1.2rem;max-width:46rem}li{margin:.2rem 0}
.notes{list-style:none;padding:0}.notes li{padding:.35rem .8rem;border-left:3px solid var(--rule);
margin:.4rem 0;overflow-wrap:anywhere}.notes .warning{border-color:var(--orange)}
.notes .bad{border-color:var(--red)}.notes b{font-weight:600}
summary{cursor:pointer;margin:.4rem 0}.warning b{color:var(--orange)}.bad b{color:var(--red)}.info b{color:var(--soft)}
figure{margin:1.4rem 0 2.2rem;break-inside:avoid}
figcaption{margin:0 0 .7rem}figcaption b{display:block;font-weight:600}
figcaption span{color:var(--soft);font-size:.9rem}
.wide{overflow-x:auto;margin:1rem 0 1.6rem;break-inside:avoid}
table{border-collapse:collapse;width:100%;font-size:.92rem;font-variant-numeric:tabular-nums}
caption{text-align:left;color:var(--soft);font-size:.9rem;padding-bottom:.4rem}
th,td{padding:.35rem .9rem .35rem 0;text-align:left;vertical-align:top;border-bottom:1px solid var(--rule)}
th{font-weight:600}thead th{color:var(--soft);font-weight:500}tbody th{font-weight:500}
h3{font-size:1rem;font-weight:600;margin:2.2rem 0 .6rem}.part+.part{margin-top:3rem}
.sides{display:grid;grid-template-columns:1fr 1fr;gap:.9rem 1.6rem;margin:.6rem 0 1.2rem}
.sides div{border-top:3px solid var(--rule);padding-top:.35rem}.sides div:nth-child(2){border-color:var(--blue)}
.sides div:nth-child(n+3){grid-column:1/-1}.sides b{color:var(--soft);font-size:.82rem;font-weight:500}
.sides p{margin:.1rem 0}.contents ul{list-style:none;padding:0;margin:.2rem 0 1rem;max-width:none;columns:24rem;
column-gap:2.4rem}.contents li{display:flex;justify-content:space-between;gap:1rem;margin:0;padding:.28rem 0;
border-bottom:1px solid var(--grid);break-inside:avoid;font-size:.92rem}.contents li span{color:var(--soft);
font-size:.82rem;white-space:nowrap}.contents p{margin:.9rem 0 0;font-weight:600}
a{color:var(--blue);text-decoration:none}a:hover{text-decoration:underline}
section,h2,h3{scroll-margin-top:1rem}
.conclusion:empty{display:none}
.sign{display:flex;gap:2.5rem;margin:4.5rem 0 0;break-inside:avoid}
.sign div{flex:1;border-top:1px solid var(--ink);padding-top:.3rem;color:var(--soft);font-size:.85rem}
footer{margin-top:3rem;color:var(--soft);font-size:.85rem}
@media(max-width:38rem){main{padding:1.5rem 1rem 3rem}.conclusion{font-size:1.25rem}.sides{grid-template-columns:1fr}
.sides div{grid-column:1}.contents li{display:block}th,td{padding-right:.6rem;min-width:4.6rem}
table{font-size:.86rem}.stacks,.stacks tbody,.stacks thead{display:block}.stacks tr{display:grid;
grid-template-columns:4fr 5fr 3fr}.stacks th:first-child{grid-column:1/-1}.stacks thead th:first-child{display:none}
.stacks tbody th{border:0;padding-bottom:0}.stacks td:only-of-type{grid-column:1/-1}
figure{overflow-x:auto}figcaption{position:sticky;left:0}.pm-figure{min-width:38rem}}
@page{size:A4;margin:15mm 17mm;@bottom-right{content:"page " counter(page) " of " counter(pages);font:8pt sans-serif;color:#666}}
@media print{body{font-size:10pt;line-height:1.4}main{max-width:none;padding:0}.conclusion{font-size:15pt}
h2{font-size:12.5pt;margin:1.2rem 0 .4rem;break-after:avoid}p,ul{max-width:none}.sheet{break-before:page}
.wide{overflow:visible;margin:.7rem 0 1.1rem}table{font-size:9pt}th,td{padding:.22rem .7rem .22rem 0}
h3{break-after:avoid}.contents{break-after:page}tr,li,.signed,.sides{break-inside:avoid}.sign{margin-top:2.9rem}footer{margin-top:1.6rem;break-inside:avoid}}
)";
}

}  // namespace proofmass::report
