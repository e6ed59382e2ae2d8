"""Fifty names that would be markup, script or worse, where a page took them for more than text."""

from __future__ import annotations

ATTACK = "window.struck=1"
_ELEMENTS = (
    f"<script>{ATTACK}</script>", f"</script><script>{ATTACK}</script>", f"</SCRIPT ><script>{ATTACK}//",
    f"<!--<script>{ATTACK}</script>", f"--><script>{ATTACK}</script>", f"<img src=x onerror={ATTACK}>",
    f"<svg onload={ATTACK}>", f"<svg><script>{ATTACK}</script></svg>", f"<body onload={ATTACK}>",
    f"<iframe srcdoc='<script>parent.{ATTACK}</script>'>", f"<iframe src=javascript:{ATTACK}>",
    f"<a href=javascript:{ATTACK}>x</a>", f"<details open ontoggle={ATTACK}>", f"<input autofocus onfocus={ATTACK}>",
    f"<video><source onerror={ATTACK}></video>", f"<math><mtext><script>{ATTACK}</script>",
    f"<object data='data:text/html,<script>{ATTACK}</script>'>", "<embed src=//example.org/x>",
    "<base href=//example.org/>", "<meta http-equiv=refresh content='0;url=//example.org'>",
    "<link rel=stylesheet href=//example.org/x.css>", "<style>*{display:none}</style>", "</style><script>x</script>",
    "<form action=//example.org><button>", f"<template><script>{ATTACK}</script></template>",
)  # fmt: skip
_QUOTES = (
    f"'+{ATTACK}+'", f'"+{ATTACK}+"', f"`${{{ATTACK}}}`", f"';{ATTACK};//", f'";{ATTACK};//', f"\\';{ATTACK};//",
    f'" onmouseover="{ATTACK}', f"' onmouseover='{ATTACK}", f"{{{{{ATTACK}}}}}", "{{script}}", "{{run}}", "{{policy}}",
    f"{{% {ATTACK} %}}", f"<%= {ATTACK} %>", f"javascript:{ATTACK}", f"&lt;script&gt;{ATTACK}&lt;/script&gt;",
    f"&#60;script&#62;{ATTACK}", "]]>", "<![CDATA[x]]>", "__proto__", "constructor", "\x00<b>\x1b[31m",
    "\u2028\u2029<b>", "\ud83d<b>", "\u202e<b>",
)  # fmt: skip
NAMES = (*_ELEMENTS, *_QUOTES)
