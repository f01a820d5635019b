autocmd BufRead,BufNewFile *.lsys,*.rifs,*.inst setfiletype graftal
