# SPDX-License-Identifier: BSD-3-Clause
# gnuplot tests/bench/work_precision.gp
# Draws docs/accuracy/released_rod.svg from released_rod.csv there. -e "folder='X'" takes another folder,
# -e "kind='png'" makes a PNG.
if (!exists("folder")) folder = 'docs/accuracy'
if (!exists("kind")) kind = 'svg'
set datafile separator ','
if (kind eq 'png') {
  set terminal pngcairo size 1000,640 font 'DejaVu Sans,11'
} else {
  set terminal svg size 1000,640 font 'DejaVu Sans,11' background rgb 'white'
}
set output folder.'/released_rod.'.kind
data = folder.'/released_rod.csv'

set logscale xy
set format x '10^{%T}'
set format y '10^{%T}'
set xlabel 'CPU time for one second of the released rod, s'
set ylabel 'largest tip error / L'
set xrange [2e-3:5]
set yrange [1e-8:1]
set grid xtics ytics lt 1 lc rgb '#e4e4e4'
set key outside right top spacing 1.2 samplen 2
set border 3
set tics nomirror

# what is asked for: 1e-3 L in 0.1 s
set object 1 rectangle from graph 0,0 to 0.1,1e-3 fillcolor rgb '#eef5ea' fillstyle solid noborder behind
set label 1 'asked for' at 2.3e-3,1.6e-8 textcolor rgb '#5f8a4a'

worst(at_steps, between) = at_steps > between ? at_steps : between
chosen(scheme, mode, n) = (strcol(1) eq scheme && strcol(2) eq mode && $5 == n && $14 == 0)

schemes = 'backward_euler bdf2 bdf_alpha(-0.4) bdf_alpha(-0.2) generalized_alpha(0.8) tr_bdf2 esdirk32 esdirk43'
colours = '#8c8c8c #b07aa1 #e15759 #f2a06b #59a14f #edc948 #4e79a7 #111111'
set datafile missing NaN

plot \
  data using 9:(worst($6, $7)) skip 1 with points pt 7 ps 0.25 lc rgb '#bbbbbb' title 'all runs', \
  for [i=1:8] data using (chosen(word(schemes, i), 'fixed', 6) ? $9 : NaN):(worst($6, $7)) skip 1 \
    with linespoints pt 7 ps 0.55 lw 1.8 lc rgb word(colours, i) title word(schemes, i).', steps' noenhanced, \
  for [i=6:8] data using (chosen(word(schemes, i), 'adaptive', 6) ? $9 : NaN):(worst($6, $7)) skip 1 \
    with linespoints pt 6 ps 0.55 lw 1.5 dt 2 lc rgb word(colours, i) title word(schemes, i).', tolerances' noenhanced
