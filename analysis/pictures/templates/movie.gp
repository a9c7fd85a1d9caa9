# Pictures of one size after each other: frame[1], frame[2], ... are files in the folder above.
set terminal gif truecolor animate delay 25 loop 0 size page_width,page_height background rgb 'white'
set output output_file
unset label
unset border
unset tics
unset key
unset xlabel
unset ylabel
set margins 0, 0, 0, 0
set xrange [0:page_width - 1]
set yrange [0:page_height - 1]
do for [i = 1:frames] { plot '../'.frame[i] binary filetype=png with rgbimage notitle }
