;; F x for the rows of F, three bands at once: x and F x hold a vector of 32-bit floats an unknown, (red, green,
;; blue, 0). An entry of a row costs one broadcast, one product and one sum; four running sums take turns, since a sum
;; is not there for the next entry at once. Rows lie behind one another, so addresses only step on.
(module
  (import "page" "memory" (memory 0))

  ;; Addresses: begin (u32, rows + 1), column (u16) and value (f32) of the first entry, x, out.
  (func (export "product")
    (param $rows i32) (param $begin i32) (param $column i32) (param $value i32) (param $x i32) (param $out i32)
    (local $a v128) (local $b v128) (local $c v128) (local $d v128)
    (local $left i32) (local $end i32)
    (local.set $end (i32.add (local.get $out) (i32.shl (local.get $rows) (i32.const 4))))
    (loop $row
      (if (i32.lt_u (local.get $out) (local.get $end)) (then
        (local.set $left (i32.sub (i32.load offset=4 (local.get $begin)) (i32.load (local.get $begin))))
        (local.set $a (v128.const f32x4 0 0 0 0))
        (local.set $b (local.get $a))
        (local.set $c (local.get $a))
        (local.set $d (local.get $a))
        (loop $four
          (if (i32.ge_u (local.get $left) (i32.const 4)) (then
            (local.set $a (f32x4.add (local.get $a) (f32x4.mul
              (v128.load32_splat (local.get $value))
              (v128.load (i32.add (local.get $x)
                (i32.shl (i32.load16_u (local.get $column)) (i32.const 4)))))))
            (local.set $b (f32x4.add (local.get $b) (f32x4.mul
              (v128.load32_splat offset=4 (local.get $value))
              (v128.load (i32.add (local.get $x)
                (i32.shl (i32.load16_u offset=2 (local.get $column)) (i32.const 4)))))))
            (local.set $c (f32x4.add (local.get $c) (f32x4.mul
              (v128.load32_splat offset=8 (local.get $value))
              (v128.load (i32.add (local.get $x)
                (i32.shl (i32.load16_u offset=4 (local.get $column)) (i32.const 4)))))))
            (local.set $d (f32x4.add (local.get $d) (f32x4.mul
              (v128.load32_splat offset=12 (local.get $value))
              (v128.load (i32.add (local.get $x)
                (i32.shl (i32.load16_u offset=6 (local.get $column)) (i32.const 4)))))))
            (local.set $column (i32.add (local.get $column) (i32.const 8)))
            (local.set $value (i32.add (local.get $value) (i32.const 16)))
            (local.set $left (i32.sub (local.get $left) (i32.const 4)))
            (br $four))))
        (loop $one
          (if (local.get $left) (then
            (local.set $a (f32x4.add (local.get $a) (f32x4.mul
              (v128.load32_splat (local.get $value))
              (v128.load (i32.add (local.get $x)
                (i32.shl (i32.load16_u (local.get $column)) (i32.const 4)))))))
            (local.set $column (i32.add (local.get $column) (i32.const 2)))
            (local.set $value (i32.add (local.get $value) (i32.const 4)))
            (local.set $left (i32.sub (local.get $left) (i32.const 1)))
            (br $one))))
        (v128.store (local.get $out)
          (f32x4.add (f32x4.add (local.get $a) (local.get $b)) (f32x4.add (local.get $c) (local.get $d))))
        (local.set $out (i32.add (local.get $out) (i32.const 16)))
        (local.set $begin (i32.add (local.get $begin) (i32.const 4)))
        (br $row))))))
