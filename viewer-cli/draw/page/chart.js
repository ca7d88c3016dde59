/* A CHART of page.h as an option of Apache ECharts. Run by browsers and by the program itself, which has no DOM: ES5. */
var glintChart = (function () {
    'use strict';

    /* Okabe and Ito's colours and two of Tol's, told apart by every kind of eye; shapes tell series apart without them. */
    var LIGHT = {colors: ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#56b4e9', '#e69f00', '#882255', '#999933'],
                 text: '#1f2328', faint: '#59636e', line: '#d8dee4', muted: '#8c959f', ground: '#ffffff'};
    var DARK = {colors: ['#56b4e9', '#e69f00', '#2fc79a', '#e39ac4', '#f0e442', '#7f9cff', '#c66a8e', '#a8ab52'],
                text: '#e6e8eb', faint: '#9da7b3', line: '#30363d', muted: '#6e7681', ground: '#16181d'};
    /* Each with its middle on the point. */
    var SYMBOLS = ['circle', 'diamond', 'triangle', 'rect', 'path://M0 0L10 0L5 10Z',
                   'path://M3 0L7 0L7 3L10 3L10 7L7 7L7 10L3 10L3 7L0 7L0 3L3 3Z'];
    var FONT = 'system-ui, Segoe UI, DejaVu Sans, sans-serif'; /* without quotes: the renderer escapes no attributes */

    function escaped(c) {
        var code = c.charCodeAt(0), digits = code.toString(16);
        return code < 0x80 ? '\\x' + ('0' + digits).slice(-2) : '\\u' + ('000' + digits).slice(-4);
    }

    /* A text as it is shown: hidden characters as escapes, as in capture-format/names/shown.c, except for line breaks and tabs, and nothing that XML has no way to
       say, such as halves of surrogate pairs. */
    function text(value) {
        return (value === undefined || value === null ? '' : String(value))
            .replace(/[\u0000-\u0008\u000b-\u001f\u007f-\u009f\u00ad\u061c\u180e\u200b\u200e\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb\ufffe\uffff]/g, escaped)
            .replace(/\udb40[\udc00-\udc7f]/g, function (tag) { return '\\U000e00' + ('0' + (tag.charCodeAt(1) - 0xdc00).toString(16)).slice(-2); })
            .replace(/[\ud800-\udbff](?![\udc00-\udfff])/g, '\u00b7')
            .replace(/(^|[^\ud800-\udbff])[\udc00-\udfff]/g, '$1\u00b7');
    }

    /* Of bars, and of what is drawn over them. */
    var BARS = {barMaxWidth: 26, barGap: '10%', barCategoryGap: '25%'};

    function isNumber(v) { return typeof v === 'number' && isFinite(v); }

    function list(v) { return Array.isArray(v) ? v : []; }

    function object(v) { return v && typeof v === 'object' ? v : {}; }

    function label(axis) { return text(axis.name) + (axis.unit ? ', ' + text(axis.unit) : ''); }

    /* As few digits as a number needs, at most four, or as many as are given. */
    function number(v, digits) {
        if (!isNumber(v)) return '\u2013';
        if (v === 0) return '0';
        var size = Math.abs(v);
        if (size >= 1e6 || size < 1e-4) return v.toExponential(2).replace(/\.?0+e/, 'e').replace('e+', 'e').replace('-', '\u2212');
        return String(+v.toPrecision(digits || 4)).replace('-', '\u2212');
    }

    /* [x, y] or {…} as one kind of object; null when an axis cannot show it. */
    function pointOf(p, x, y) {
        var point = Array.isArray(p) ? {x: p[0], y: p[1]} : object(p);
        if (!isNumber(point.x) || !isNumber(point.y)) return null;
        if ((x.scale === 'log' && point.x <= 0) || (y.scale === 'log' && point.y <= 0)) return null;
        return point;
    }

    /* Every point that can be shown, series by series, and how many cannot. */
    function read(chart) {
        var x = object(chart.x), y = object(chart.y), left = 0;
        var series = list(chart.series).map(object).map(function (s) {
            var points = list(s.points).map(function (p) { return pointOf(p, x, y); });
            var shown = points.filter(function (p) { return p; });
            left += points.length - shown.length;
            return {name: text(s.name), kind: ['scatter', 'bar', 'front'].indexOf(s.kind) < 0 ? 'line' : s.kind, muted: !!s.muted, stack: s.stack, points: shown};
        });
        return {x: x, y: y, series: series, left: left, marks: list(chart.marks).map(object)};
    }

    /* Lowest and highest of an axis, with intervals and marks. */
    function extent(data, key) {
        var axis = data[key], low = Infinity, high = -Infinity;
        function add(v) {
            if (!isNumber(v) || (axis.scale === 'log' && v <= 0)) return;
            low = Math.min(low, v);
            high = Math.max(high, v);
        }
        data.series.forEach(function (s) {
            s.points.forEach(function (p) {
                add(p[key]);
                var low = key === 'x' ? p.x_low : p.low, high = key === 'x' ? p.x_high : p.high;
                add(low);
                add(high);
            });
        });
        data.marks.forEach(function (m) { add(m[key]); });
        if (low > high) { low = axis.scale === 'log' ? 1 : 0; high = axis.scale === 'log' ? 10 : 1; }
        return [low, high];
    }

    /* Places that a logarithmic axis names: powers of ten, with 2 and 5, or round steps when it spans little. */
    function logTicks(low, high) {
        var ticks = [], first = Math.floor(Math.log(low) / Math.LN10), last = Math.ceil(Math.log(high) / Math.LN10);
        var decades = Math.log(high / low) / Math.LN10;
        if (!(low > 0 && high > low * 1.001)) return ticks;
        if (decades < 0.6) {
            var step = Math.pow(10, Math.floor(Math.log((high - low) / 4) / Math.LN10)), times = (high - low) / 4 / step;
            step *= times > 5 ? 10 : times > 2 ? 5 : times > 1 ? 2 : 1;
            for (var v = Math.ceil(low / step) * step; v <= high * (1 + 1e-9); v += step) ticks.push(+v.toPrecision(10));
            return ticks;
        }
        var each = decades > 3 ? [1] : [1, 2, 5], skip = Math.ceil(decades / 8);
        for (var e = first; e <= last; e++)
            for (var k = 0; k < each.length && (e - first) % skip === 0; k++) {
                var t = +(each[k] * Math.pow(10, e)).toPrecision(10);
                if (t >= low * (1 - 1e-9) && t <= high * (1 + 1e-9)) ticks.push(t);
            }
        return ticks;
    }

    /* Names below an axis that is too short for them stand on end. */
    function standCategories(option, width) {
        var longest = Math.max.apply(null, option.data.map(function (t) { return t.length; }).concat(0)) * 6.4;
        if (longest + 6 < (width - 110) / Math.max(1, option.data.length)) return;
        option.axisLabel.rotate = 90;
        option.nameGap = 18 + longest;
    }

    /* Digits that tell the ticks of a narrow range apart. */
    function digitsOf(range) {
        var size = Math.max(Math.abs(range[0]), Math.abs(range[1])), span = range[1] - range[0];
        return size > 0 && span > 0 ? Math.min(10, Math.max(4, Math.ceil(Math.log10(size / span)) + 2)) : 4;
    }

    function axisOption(data, key, look, width) {
        var axis = data[key], lying = key === 'y' && axis.scale === 'category';
        var option = {
            name: label(axis), nameLocation: lying ? 'end' : 'middle', nameTextStyle: {color: look.faint, fontSize: 12},
            nameMoveOverlap: false, nameGap: key === 'x' ? 28 : 44,
            axisLine: {show: key === 'x' || lying, onZero: false, lineStyle: {color: look.muted}},
            axisTick: {show: false}, axisLabel: {color: look.faint, fontSize: 11},
            splitLine: {show: axis.scale !== 'category', lineStyle: {color: look.line}}
        };
        if (axis.scale === 'category') {
            option.type = 'category';
            option.data = list(axis.categories).map(text);
            option.inverse = lying;
            option.axisLabel.interval = 0;
            option.axisLabel.width = lying ? 220 : undefined;
            option.axisLabel.overflow = 'truncate';
            if (!lying) standCategories(option, width);
            return option;
        }
        var range = extent(data, key), bars = data.series.some(function (s) { return s.kind === 'bar'; });
        option.type = axis.scale === 'log' ? 'log' : 'value';
        var digits = option.type === 'log' ? 4 : digitsOf(range);
        option.axisLabel.formatter = function (v) { return number(v, digits); };
        if (key === 'y' && option.type !== 'log' && range[1] - range[0] < 0.05 * Math.abs(range[1])) option.nameGap += 7 * (digits - 3);
        option.scale = !bars;
        if (option.type === 'log') {
            var pad = Math.max(Math.pow(range[1] / range[0], 0.04), 1.02);
            option.min = isNumber(axis.min) && axis.min > 0 ? axis.min : range[0] / pad;
            option.max = isNumber(axis.max) && axis.max > 0 ? axis.max : range[1] * pad;
        } else {
            if (isNumber(axis.min)) option.min = axis.min;
            if (isNumber(axis.max)) option.max = axis.max;
        }
        var ticks = list(axis.ticks).filter(isNumber);
        if (!ticks.length && option.type === 'log') ticks = logTicks(option.min, option.max);
        if (ticks.length) option.axisTick.customValues = option.axisLabel.customValues = ticks;
        return option;
    }

    /* Lines between the ends of intervals, with caps: [x, y, x of one end, y of it, x of the other, y of it]. */
    function intervals(s) {
        var lines = [];
        if (s.muted) return lines; /* too many marks to tell apart */
        s.points.forEach(function (p) {
            if (isNumber(p.low) && isNumber(p.high)) lines.push([p.x, p.y, p.x, p.low, p.x, p.high]);
            if (isNumber(p.x_low) && isNumber(p.x_high)) lines.push([p.x, p.y, p.x_low, p.y, p.x_high, p.y]);
        });
        return lines;
    }

    /* `group`: [place, count] among bars that stand beside each other, null for points. */
    function intervalSeries(s, lines, color, group) {
        return {
            type: 'custom', name: s.name, silent: true, data: lines, itemStyle: {color: color}, z: group ? 6 : 3,
            encode: {x: [0, 2, 4], y: [1, 3, 5]}, clip: true, animation: false, tooltip: {show: false},
            renderItem: function (params, api) {
                var a = api.coord([api.value(2), api.value(3)]), b = api.coord([api.value(4), api.value(5)]);
                var upright = Math.abs(a[0] - b[0]) < Math.abs(a[1] - b[1]), cap = group ? 5 : 3.5;
                var across = group ? api.barLayout({count: group[1], barMaxWidth: BARS.barMaxWidth, barGap: BARS.barGap,
                                                        barCategoryGap: BARS.barCategoryGap})[group[0]].offsetCenter : 0;
                if (upright) { a[0] += across; b[0] += across; } else { a[1] += across; b[1] += across; }
                var dx = upright ? cap : 0, dy = upright ? 0 : cap;
                return {type: 'path', shape: {pathData:
                    'M' + a[0] + ' ' + a[1] + 'L' + b[0] + ' ' + b[1] +
                    'M' + (a[0] - dx) + ' ' + (a[1] - dy) + 'L' + (a[0] + dx) + ' ' + (a[1] + dy) +
                    'M' + (b[0] - dx) + ' ' + (b[1] - dy) + 'L' + (b[0] + dx) + ' ' + (b[1] + dy)},
                    style: {stroke: color, lineWidth: 1.2, fill: 'none', opacity: group ? 1 : 0.75}};
            }
        };
    }

    /* What carries a series' points: bars, or marks. `faded`: its colour is another series' too. */
    function markedOption(s, color, symbol, look, faded) {
        var option = {
            name: s.name, type: s.kind === 'bar' ? 'bar' : 'scatter', color: color, animation: false, z: s.muted ? 2 : 4,
            data: s.points.map(function (p, i) { return {value: [p.x, p.y], point: i, name: text(p.name)}; })
        };
        if (s.kind === 'bar') {
            for (var key in BARS) option[key] = BARS[key];
            option.emphasis = {itemStyle: {borderColor: look.text, borderWidth: 1.5}};
            if (s.stack) option.stack = text(s.stack);
            option.itemStyle = {borderColor: 'transparent', borderWidth: s.stack ? 0.5 : 0, opacity: faded ? 0.5 : 1};
            return option;
        }
        option.symbol = symbol;
        option.symbolSize = s.muted ? 6 : symbol === 'circle' ? 8 : 10;
        option.itemStyle = {color: color, opacity: s.muted || faded ? 0.55 : 1};
        return option;
    }

    /* The line through the marks, which it must not keep from the pointer. */
    function lineOption(s, color, symbol) {
        var front = s.kind === 'front', data = s.points.map(function (p) { return [p.x, p.y]; });
        if (front) data.sort(function (a, b) { return a[0] - b[0]; });
        return {
            name: s.name, type: 'line', color: color, animation: false, silent: true, z: s.muted ? 1 : 3, data: data,
            symbol: symbol, showSymbol: false, step: front ? 'end' : false, tooltip: {show: false},
            lineStyle: {width: front ? 1.5 : 2, color: color}
        };
    }

    function hasLine(s) { return s.kind === 'front' || s.kind === 'line'; }

    /* Lines across and single points, on a series of their own. */
    function markSeries(marks, look) {
        var lines = [], points = [];
        marks.forEach(function (m) {
            if (isNumber(m.x) && isNumber(m.y))
                points.push({value: [m.x, m.y], label: {show: true, position: 'top', distance: 8, formatter: text(m.label)}});
            else if (isNumber(m.x)) lines.push({xAxis: m.x, label: {formatter: text(m.label), position: 'insideEndTop'}});
            else if (isNumber(m.y)) lines.push({yAxis: m.y, label: {formatter: text(m.label), position: 'insideStartTop'}});
        });
        return {
            type: 'scatter', silent: true, animation: false, z: 5, data: points, symbol: 'circle', symbolSize: 16,
            itemStyle: {color: 'transparent', borderColor: look.text, borderWidth: 1.5},
            label: {color: look.text, fontSize: 12, fontWeight: 600}, tooltip: {show: false},
            markLine: {silent: true, animation: false, symbol: 'none', precision: 20, data: lines,
                       lineStyle: {type: 'dashed', color: look.faint, width: 1}, label: {color: look.faint, fontSize: 11}}
        };
    }

    /* Lines of a legend as wide as its texts most likely are; ECharts leaves the place for it to others. */
    function legendLines(names, width) {
        var lines = 1, x = 12;
        names.forEach(function (name) {
            var item = 50 + 6.6 * name.length;
            if (x > 12 && x + item > width - 12) { lines++; x = 12; }
            x += item;
        });
        return names.length > 1 ? lines : 0;
    }

    /* What the page and the file share. `titled`: the title is part of the picture. */
    function option(chart, look, titled, width) {
        var data = read(chart), bars = [], series = [], next = 0;
        data.series.forEach(function (s) {
            var group = s.stack ? 'stack ' + s.stack : s.name;
            if (s.kind === 'bar' && bars.indexOf(group) < 0) bars.push(group);
        });
        data.series.forEach(function (s) {
            var color = s.muted ? look.muted : look.colors[next % look.colors.length], faded = !s.muted && next >= look.colors.length;
            var symbol = s.muted ? 'circle' : SYMBOLS[next % SYMBOLS.length], lines = intervals(s);
            if (!s.muted) next++;
            if (hasLine(s)) series.push(lineOption(s, color, symbol));
            series.push(markedOption(s, color, symbol, look, faded));
            if (lines.length)
                series.push(intervalSeries(s, lines, s.kind === 'bar' ? look.text : color, s.kind !== 'bar' ? null :
                    [bars.indexOf(s.stack ? 'stack ' + s.stack : s.name), bars.length]));
        });
        if (data.marks.length) series.push(markSeries(data.marks, look));
        var names = data.series.map(function (s) { return s.name; }), lines = legendLines(names, width);
        var title = titled && chart.title;
        return {
            animation: false, backgroundColor: look.ground, textStyle: {fontFamily: FONT, color: look.text},
            title: {show: !!title, text: text(chart.title), left: 12, top: 8,
                    textStyle: {color: look.text, fontSize: 14, fontWeight: 600}},
            legend: {show: lines > 0, data: names, left: 12, top: title ? 34 : 4, itemGap: 16,
                     textStyle: {color: look.text, fontSize: 12}, inactiveColor: look.line},
            grid: {left: 12, right: 24, top: 20 + (title ? 30 : 0) + 26 * lines, bottom: 12,
                   outerBoundsMode: 'same', outerBoundsContain: 'all'},
            xAxis: axisOption(data, 'x', look, width), yAxis: axisOption(data, 'y', look, width), series: series
        };
    }

    /* For each series, the place of what carries its points among the option's, where lines and intervals are series of
       their own. */
    function places(chart) {
        var next = 0;
        return read(chart).series.map(function (s) {
            var place = next + (hasLine(s) ? 1 : 0);
            next = place + (intervals(s).length ? 2 : 1);
            return place;
        });
    }

    /* The picture's size: lying bars grow with their number. */
    function size(chart) {
        var y = object(chart.y), rows = y.scale === 'category' ? list(y.categories).length : 0;
        function side(v, usual) { return Math.min(Math.max(isNumber(v) ? v : usual, 200), 4000); }
        return [side(chart.width, 760), side(chart.height, rows ? 110 + 30 * rows : 440)];
    }

    /* As SVG, in ASCII, whatever the texts hold; the same for the same chart. */
    function svg(description) {
        var chart = object(description), of = size(chart), drawn = echarts.init(null, null, {renderer: 'svg', ssr: true, width: of[0], height: of[1]});
        drawn.setOption(option(chart, LIGHT, true, of[0]));
        // ECharts counts the names that it gives over all charts.
        var names = [], result = drawn.renderToSVGString().replace(/\bzr\d+-([a-z]+)-?\d+\b/g, function (name, kind) {
            if (names.indexOf(name) < 0) names.push(name);
            return 'zr0-' + kind + '-' + names.indexOf(name);
        });
        drawn.dispose();
        return result.replace(/[\ud800-\udbff][\udc00-\udfff]|[^\u0000-\u007f]/g, function (c) {
            var high = c.charCodeAt(0);
            return '&#' + (c.length < 2 ? high : 0x10000 + ((high - 0xd800) << 10) + c.charCodeAt(1) - 0xdc00) + ';';
        }) + '\n';
    }

    return {light: LIGHT, dark: DARK, text: text, number: number, label: label, read: read, option: option, places: places, size: size, svg: svg};
})();
